#!/usr/bin/env python3
"""Runs the cases under cases/ and compares them with what their case.toml expects.

    python3 tools/validate.py [--program build/fabrica] [--out out/cases] [--threads N] [--no-run] [case ...]

A case.toml names its deck and holds [[check]] tables:

    name      what is compared
    model     a column of a result, "<database>:<column>": "rwforc:normal_force:1"; a quotient of two is allowed,
              "glstat:hourglass_energy / glstat:internal_energy"
    over      a second column (optional): the mean is then taken over it, not over time
    range     its interval, [from, to] (optional)
    statistic mean | last | max | min
    expected  a number
    tolerance relative to expected, or absolute where expected is 0

Prints one line per check; the exit status is 1 if any fails.
"""
import argparse
import csv
import pathlib
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Results:
    """The csv histories of one run, each read once."""

    def __init__(self, folder):
        self.folder = folder
        self.tables = {}

    def column(self, text):
        """Values of "<database>:<column>" or of a quotient of two such columns."""
        if " / " in text:
            above, below = (self.column(part.strip()) for part in text.split(" / "))
            return [a / b if b != 0 else 0.0 for a, b in zip(above, below)]
        database, name = text.split(":", 1)
        table = self.table(database)
        if name not in table:
            raise KeyError(f"{database} has no column {name}; it has {', '.join(table)}")
        return table[name]

    def table(self, database):
        if database not in self.tables:
            with open(self.folder / f"{database}.csv", newline="") as file:
                rows = list(csv.reader(file))
            columns = zip(*[[float(v) for v in row] for row in rows[1:]])
            self.tables[database] = dict(zip(rows[0], columns))
        return self.tables[database]


def mean_over(x, y, low, high):
    """Integral of y dx over the length of the path of x within [low, high], by the trapezoid rule."""
    work = way = 0.0
    for x0, x1, y0, y1 in zip(x, x[1:], y, y[1:]):
        if low <= min(x0, x1) and max(x0, x1) <= high:
            work += 0.5 * (y0 + y1) * (x1 - x0)
            way += x1 - x0
    if way == 0:
        raise ValueError(f"the run never passes from {low} to {high}")
    return work / way


def statistic(check, results):
    y = results.column(check["model"])
    kind = check["statistic"]
    if kind == "last":
        return y[-1]
    if kind in ("max", "min"):
        return max(y) if kind == "max" else min(y)
    if kind != "mean":
        raise ValueError(f"unknown statistic {kind}")
    database = check["model"].split(":", 1)[0]
    x = results.column(check.get("over", f"{database}:time"))
    if len(x) != len(y):
        raise ValueError(f"{check['model']} and {check['over']} are not sampled at the same times")
    low, high = check.get("range", (min(x), max(x)))
    return mean_over(x, y, low, high)


def passes(check, value):
    scale = abs(check["expected"]) or 1.0
    return abs(value - check["expected"]) <= check["tolerance"] * scale


def run_case(folder, arguments):
    case = tomllib.loads((folder / "case.toml").read_text())
    out = pathlib.Path(arguments.out) / folder.name
    print(f"{folder.name}: {case['title']}")
    if not arguments.no_run:
        command = [arguments.program, "run", str(folder / case["deck"]), "--out", str(out), "--quiet",
                   "--threads", str(arguments.threads)]
        done = subprocess.run(command, stdout=subprocess.DEVNULL)
        if done.returncode != 0:
            print(f"  FAIL  the run ended with status {done.returncode}")
            return False
    results, good = Results(out / "csv"), True
    for check in case.get("check", []):
        try:
            value = statistic(check, results)
            ok = passes(check, value)
            shown = f"{value:.5g}, expected {check['expected']:.5g} within {check['tolerance']:.3g}"
        except (KeyError, ValueError, OSError) as problem:
            ok, shown = False, str(problem)
        print(f"  {'ok  ' if ok else 'FAIL'}  {check['name']}: {shown}")
        good = good and ok
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", nargs="*", help="names of folders; all if none is given")
    parser.add_argument("--program", default=str(ROOT / "build" / "fabrica"))
    parser.add_argument("--out", default=str(ROOT / "out" / "cases"))
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--no-run", action="store_true", help="compare what is there already")
    arguments = parser.parse_args()
    folders = sorted(p.parent for p in (ROOT / "cases").rglob("case.toml"))
    chosen = [f for f in folders if not arguments.case or f.name in arguments.case]
    if not chosen:
        sys.exit("no such case")
    # every case runs, also after one has failed
    results = [run_case(folder, arguments) for folder in chosen]
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main()
