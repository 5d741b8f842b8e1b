#!/usr/bin/env python3
"""Writes a block of 8000 steel bricks of which one layer is a tenth as high, to time mass scaling.

python3 tools/thin_layer.py --scaling selective > thin.k. Units: mm, ms, kg, kN, GPa.
"""
import argparse

SIDE, THIN, THIN_HEIGHT = 20, 10, 0.1  # bricks of 1 mm along each edge; the layer that is thin
DENSITY, MODULUS = 7.85e-6, 200.0
SPEED = (MODULUS / DENSITY) ** 0.5  # of sound, nu = 0
# IMSCL and DT2MS in transits of sound through a whole brick
SCALINGS = {"none": None, "conventional": (0, 0.8), "selective": (1, 0.8), "all": (1, 1.1)}


def node(i, j, k):
    return 1 + i + (SIDE + 1) * (j + (SIDE + 1) * k)


def height(k):
    return k if k <= THIN else k - 1 + THIN_HEIGHT


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--scaling", choices=SCALINGS, default="none")
    scaling = SCALINGS[arguments.parse_args().scaling]
    range_of = range(SIDE + 1)
    out = ["*KEYWORD", "*CONTROL_TERMINATION", f"{540 / SPEED:g},", "*SECTION_SOLID", "1,1",
           "*MAT_ELASTIC", f"1,{DENSITY},{MODULUS},0.0", "*PART", "block", "1,1,1"]
    if scaling:
        out += ["*CONTROL_TIMESTEP", f"0,0.9,0,0,{-scaling[1] / SPEED:.9g}", f"0,0,{scaling[0]}"]
    out.append("*NODE")
    out += [f"{node(i, j, k)},{i},{j},{height(k):g}" for k in range_of for j in range_of for i in range_of]
    out.append("*ELEMENT_SOLID")
    cells = [(i, j, k) for k in range(SIDE) for j in range(SIDE) for i in range(SIDE)]
    corners = [(a, b, c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    for e, (i, j, k) in enumerate(cells, 1):
        out.append(f"{e},1," + ",".join(str(node(i + a, j + b, k + c)) for a, b, c in corners))
    out.append("*INITIAL_VELOCITY_NODE")
    out += [f"{node(i, j, SIDE)},0,0,{1 + 0.1 * i:g}" for j in range_of for i in range_of]
    print("\n".join(out + ["*END"]))


if __name__ == "__main__":
    main()
