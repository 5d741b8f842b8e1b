#!/usr/bin/env python3
"""tools/shaft_sections.py on a shaft whose answer is known: a tube of ellipses has the areas of the table at its fractions
afterwards, its shape and centre everywhere, and its own size at both ends."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import shaft_sections

LOW, HIGH, A, B = -300.0, 20.0, 13.0, 10.0
HEIGHTS = [LOW + 4 * i for i in range(81)]


def slice_at(height):
    # (x - cx) / A and (y - cy) / B on a circle: coefficients (A + B) / 2 of exp(it), (A - B) / 2 of exp(-it). Its first point
    # sits off the centroid's coefficient, as measured ones do.
    return {"s_mm": repr(height), "sign": "1", "area_mm2": repr(math.pi * A * B), "cx_mm": "3", "cy_mm": "-5",
            "re0": "3.5", "im0": "-5", "re1": repr((A + B) / 2), "im1": "0", "re-1": repr((A - B) / 2), "im-1": "0"}


failed = []


def check(what, is_so):
    if not is_so:
        failed.append(what)


rows = [slice_at(h) for h in HEIGHTS]
sized = shaft_sections.sized("humerus", rows, LOW, HIGH)
areas = shaft_sections.areas(sized)
table = shaft_sections.sections("humerus")
check("table of the humerus", [t[0] for t in table] == [0.2, 0.35, 0.5, 0.65, 0.8])
for fraction, area, slope, length in table:
    target = area + slope * (HIGH - LOW - length)
    got = shaft_sections.between(areas, HIGH - fraction * (HIGH - LOW))
    check(f"area at {fraction}: {got:.2f} for {target:.2f}", abs(got / target - 1) < 1e-9)
for row, new in zip(rows, sized):
    w = float(new["re1"]) / float(row["re1"])
    check(f"shape at {row['s_mm']}", math.isclose(float(new["re-1"]), w * float(row["re-1"])) and
          math.isclose(float(new["area_mm2"]), w * w * math.pi * A * B))
    check(f"centre at {row['s_mm']}", math.isclose(float(new["re0"]), 3 + w * 0.5) and float(new["im0"]) == -5)
check("both ends as they were", all(float(new[k]) == float(row[k]) for row, new in ((rows[0], sized[0]), (rows[-1], sized[-1]))
                                    for k in row))
check("other bones as they were", shaft_sections.sized("femur", rows, LOW, HIGH) is rows)

print("\n".join(failed) or "shafts get the areas of the table")
sys.exit(bool(failed))
