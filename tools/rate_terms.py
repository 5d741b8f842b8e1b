#!/usr/bin/env python3
"""Viscoelastic terms of a cortex whose stress goes with a power of the strain rate.

    python3 tools/rate_terms.py

Parallel to an elastoplastic spring two Maxwell terms of given times stand; pulled at a rate r to a strain e one of
modulus E and time t adds E t r (1 - exp(-e / (t r))). The moduli and a factor of the spring are fitted so that the whole
is slow(e) (r / r0)^n, in relative error, from r0 to 30 1/s, with five-fold weight at r0. All pairs of times are tried.
Prints times [ms], Young's and shear moduli [GPa] and decays [1/ms], as data/materials.csv has them for the humerus.
"""
import itertools
import math

YOUNGS, POISSON = 12.516, 0.3  # [GPa] at the rate r0, row humerus_cortical
START, POWER = 2e-5, 0.06  # r0 [1/ms], n
SLOW = {0.004: 0.050064, 0.008: 0.1, 0.013: 0.105, 0.0197: 0.112}  # strain: stress [GPa]
TIMES = (300, 100, 30, 10, 3, 1, 0.3, 0.1)  # [ms]
RATES = [START * (0.03 / START) ** (i / 18) for i in range(19)]


def solve(a, b):
    n = len(b)
    rows = [list(a[i]) + [b[i]] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, n):
            f = rows[k][i] / rows[i][i]
            rows[k] = [x - f * y for x, y in zip(rows[k], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][k] * x[k] for k in range(i + 1, n))) / rows[i][i]
    return x


def fit(times):
    """Least squares: (root mean square error, moduli over YOUNGS and the factor of the spring)."""
    rows, aims, weights = [], [], []
    for rate in RATES:
        for strain, slow in SLOW.items():
            whole = slow * (rate / START) ** POWER
            terms = [YOUNGS * t * rate * -math.expm1(-strain / (t * rate)) for t in times]
            weight = 5 if rate == START else 1
            rows.append([weight * s / whole for s in terms + [slow]])
            aims.append(weight)
            weights.append(weight)
    n = len(times) + 1
    a = [[sum(r[i] * r[k] for r in rows) for k in range(n)] for i in range(n)]
    x = solve(a, [sum(r[i] * y for r, y in zip(rows, aims)) for i in range(n)])
    errors = [(sum(p * q for p, q in zip(r, x)) - y) / w for r, y, w in zip(rows, aims, weights)]
    weighted = math.fsum((e * w) ** 2 for e, w in zip(errors, weights))
    return weighted, math.sqrt(sum(e * e for e in errors) / len(errors)), x


def main():
    fits = [(*fit(pair), pair) for pair in itertools.combinations(TIMES, 2)]
    _, error, x, times = min(f for f in fits if min(f[2]) > 0)
    youngs = x[-1] * YOUNGS
    bulk, shear = youngs / (3 * (1 - 2 * POISSON)), youngs / (2 * (1 + POISSON))
    print(f"rms {100 * error:.1f} %, E {youngs:.2f} GPa")
    for share, time in zip(x, times):
        youngs += share * YOUNGS
        now = 3 * bulk * youngs / (9 * bulk - youngs)
        print(f"{time:g} ms: E {share * YOUNGS:.2f}, GI {now - shear:.2f} GPa, BETAI {1 / time:.4g} 1/ms")
        shear = now


main()
