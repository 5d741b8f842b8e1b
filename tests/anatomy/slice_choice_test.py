#!/usr/bin/env python3
"""Which slices tools/slice_choice.py keeps, on stacks whose answer is known. Exit 77 (skipped) without numpy.

The distance to a circle is linear in its radius: slices of a cone are read back exactly between any two others, and a circle
of radius R read back with radius r is off by pi |R^2 - r^2| / (2 pi R)."""
import pathlib
import sys

try:
    import numpy  # noqa: F401
except ImportError:
    print("numpy is not here: skipped")
    sys.exit(77)
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import slice_choice


def stack(radii):
    # coefficient 1 is a circle that runs counter-clockwise
    return slice_choice.Stack([(2.5 * i, [slice_choice.outline({0: 3 - 2j, 1: r})]) for i, r in enumerate(radii)])


failed = []


def check(what, is_so):
    if not is_so:
        failed.append(what)


# 0.05 mm: a polygon of 72 sides lies up to 0.02 mm inside its circle of 20 mm, and cells of 1 mm share the rest
cone = stack([10, 12, 14, 16, 18, 20])
check("a cone needs its ends only", cone.choice(0.05) == [0, 5])

step = stack([10, 10, 10, 20, 20, 20])
for a, i, b, r in ((0, 1, 3, 10 + 10 / 3), (2, 3, 5, 10 + 10 / 3)):
    R = [10, 10, 10, 20, 20, 20][i]
    check(f"error of slice {i}", abs(step.error(a, i, b) - abs(R * R - r * r) / (2 * R)) < 0.05)
check("both sides of a step stay, even parts go", step.choice(0.5) == [0, 2, 3, 5])
check("nothing left out is worse than the bound", step.largest(step.choice(0.5))[0] <= 0.5)

pipe = [slice_choice.outline({1: 20}), slice_choice.outline({-1: 10})]  # the inner one clockwise: a hole
field = slice_choice.signed_distance(pipe, numpy.array([0j, 15 + 0j, 25 + 0j]))
check("a hole is outside", numpy.allclose(field, [10, -5, 5], atol=0.05))

print(*failed or ["all held"], sep="\n")
sys.exit(bool(failed))
