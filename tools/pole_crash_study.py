#!/usr/bin/env python3
"""Runs the car6 pole crash (a public deck, not part of this repository) for its base design and for rows of its
parameter study, and compares internal energy, last displacement and last velocity with the published results.

usage: pole_crash_study.py DECK_FOLDER [--rows N] [--threads N] [--fabrica PATH] [--out DIR]
Prints a table, mean errors and rank correlations."""
import argparse
import csv
import pathlib
import shutil
import subprocess

NAMES = ["tbumper", "trailb", "trailf", "tgrill", "thood", "ybumper", "yrailf", "yrailb", "ybody"]
BASE = dict(tbumper=3, trailb=2, trailf=5, tgrill=1, thood=1, ybumper=400, yrailf=400, yrailb=400, ybody=400)


def column(path, name):
    with open(path) as f:
        rows = list(csv.reader(f))
    i = rows[0].index(name)
    return [float(r[i]) for r in rows[1:]]


def run(args, name, parameters):
    folder = args.out / name
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(args.deck / "car6_crash_v223.k", folder / "car6_crash_v223.k")
    deck = "*KEYWORD\n*PARAMETER\n" + "".join(f"r{k},{v:.6g}\n" for k, v in parameters.items())
    (folder / "main.k").write_text(deck + "*INCLUDE\ncar6_crash_v223.k\n*END\n")
    subprocess.run([args.fabrica, "run", folder / "main.k", "--out", folder / "out", "--threads", str(args.threads),
                    "--quiet"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    csvs = folder / "out" / "csv"
    return {"IE": column(csvs / "glstat.csv", "internal_energy")[-1],
            "dmax": column(csvs / "nodout.csv", "x_displacement:605")[-1],
            "vfin": column(csvs / "matsum.csv", "x_rbvelocity:1")[-1],
            "fmax": max(abs(f) for f in column(csvs / "rwforc_forces.csv", "x_force:2"))}


def ranks(values):
    order = sorted(range(len(values)), key=lambda i: values[i])
    r = [0.0] * len(values)
    for place, i in enumerate(order):
        r[i] = float(place)
    return r


def rank_correlation(a, b):
    x, y = ranks(a), ranks(b)
    mean = (len(x) - 1) / 2
    return sum((p - mean) * (q - mean) for p, q in zip(x, y)) / sum((p - mean) ** 2 for p in x)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("deck", type=pathlib.Path)
    parser.add_argument("--rows", type=int, default=10)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--fabrica", default="build/fabrica")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/pole-crash"))
    args = parser.parse_args()
    base = run(args, "base", BASE)
    print(f"base   IE {base['IE']:.5g}  dmax {base['dmax']:.1f}  vfin {base['vfin']:.1f}  fmax {base['fmax']:.5g}"
          "   published: IE 1.2032e8-1.2042e8, dmax -641.9 to -643.9, vfin -693 to -731, fmax 7.70e5-7.76e5")
    reference = args.deck / "reference"
    rows = [[float(v) for v in line.replace(",", " ").split()] for line in (reference / "LHS_100_X.csv").read_text().splitlines()]
    published = {k: [float(v) for v in (reference / f"LHS_100_Y_{k}.csv").read_text().split()]
                 for k in ("IE", "dmax", "vfin", "fmax")}
    ours = {k: [] for k in published}
    for i in range(args.rows):
        result = run(args, f"row{i}", dict(zip(NAMES, rows[i])))
        for k in ours:
            ours[k].append(result[k])
        print(f"row {i:3}", "  ".join(f"{k} {result[k]:.5g} ({published[k][i]:.5g})" for k in ours), flush=True)
    for k in ours:
        theirs = published[k][:args.rows]
        error = sum(abs(a / b - 1) for a, b in zip(ours[k], theirs)) / args.rows
        print(f"{k}: mean error {100 * error:.2f} %, rank correlation {rank_correlation(ours[k], theirs):.3f}")


if __name__ == "__main__":
    main()
