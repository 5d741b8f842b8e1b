"""Shafts of the size of the mean man, from data/anatomy/shaft_sections.csv.

A slice of area A at the fraction f of the bone's length L from its proximal end (the greatest height) is scaled about its
centroid by

    w(f),   w(f_i)^2 A(f_i) = a_i + b_i (L - L_0)

at the fractions f_i of the table, with the mean area a_i of men whose bones are L_0 long and its slope b_i; w is linear between
these and goes to 1 over BLEND beyond the first and the last. Shape and centre-line of the shaft stay, and so do the ends.
"""
import csv
import pathlib

TABLE = pathlib.Path(__file__).resolve().parents[1] / "data" / "anatomy" / "shaft_sections.csv"
BLEND = 0.07  # of the length: from the shaft to head and condyles


def sections(bone):
    """(fraction, area, slope, length) of the mean man's shaft, none for a bone that is not in the table"""
    lines = TABLE.read_text(encoding="utf-8").splitlines()
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    return [tuple(float(row[name]) for name in ("fraction", "area_mm2", "slope_mm2_per_mm", "length_mm"))
            for row in rows if row["bone"] == bone]


def between(knots, x):
    """value at x of the line through knots (x, y) in rising order; that of the nearest end outside"""
    if x <= knots[0][0]:
        return knots[0][1]
    for (a, y), (b, z) in zip(knots, knots[1:]):
        if x <= b:
            return y + (z - y) * (x - a) / (b - a)
    return knots[-1][1]


def areas(rows):
    """(height, area) of the slices in rising order, holes taken off"""
    sums = {}
    for row in rows:
        height = float(row["s_mm"])
        sums[height] = sums.get(height, 0) + float(row["sign"]) * float(row["area_mm2"])
    return sorted(sums.items())


def scales(bone, rows, low, high):
    """(fraction, w) in rising order for a bone from height low to high"""
    own, length = areas(rows), high - low
    knots = [(f, ((a + b * (length - l0)) / between(own, high - f * length)) ** 0.5) for f, a, b, l0 in sections(bone)]
    return [(knots[0][0] - BLEND, 1.0), *knots, (knots[-1][0] + BLEND, 1.0)]


def sized(bone, rows, low, high):
    """rows of a stack with the shaft of the mean man; the same rows for a bone that is not in the table"""
    if not sections(bone):
        return rows
    knots, result = scales(bone, rows, low, high), []
    for row in rows:
        w = between(knots, (high - float(row["s_mm"])) / (high - low))
        new = dict(row, area_mm2=repr(w * w * float(row["area_mm2"])))
        for part, centre in (("re", "cx_mm"), ("im", "cy_mm")):
            for name in row:
                if name.startswith(part) and name != part + "0":
                    new[name] = repr(w * float(row[name]))
            c = float(row[centre])
            new[part + "0"] = repr(c + w * (float(row[part + "0"]) - c))
        result.append(new)
    return result


def volume(rows):
    """of the bone, from the areas of its slices"""
    own = areas(rows)
    return sum(0.5 * (a + b) * (z - y) for (y, a), (z, b) in zip(own, own[1:]))
