#!/usr/bin/env python3
"""tools/bone_sections.py on a round tube of radius R, wall t = R - r, yield s, without hardening:

    I = pi/4 (R^4 - r^4)                     layers with the area they have in the bone
    I = pi R (R^3 - r^3) / 3                 layers with the area of the reference surface, as shells integrate them
    M = 4/3 s (R^3 - r^3)                    fully plastic, the limit of a large strain at fracture

The tube is a polygon of 64 sides: areas are off by 1 - sin(a)/a, a = 2 pi / 64, that is 0.2 %. Exit 77 (skipped) without
numpy."""
import math
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("numpy is not here: skipped")
    sys.exit(77)
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import bone_sections as tool

R, t, e, sigy, sides = 13.0, 6.0, 17.0, 0.118, 64
r = R - t
deck = tool.Deck.__new__(tool.Deck)
deck.node, deck.solid, deck.shell = {}, [], []
deck.part, deck.law = {1: ("leg.right.tube.cortical", 1)}, {1: tool.Law(e, 0.3, sigy, 0)}
for ring in range(5):
    for k in range(sides):
        a = 2 * math.pi * k / sides
        deck.node[1 + ring * sides + k] = np.array([R * math.cos(a), R * math.sin(a), 10.0 * ring])
for ring in range(4):
    for k in range(sides):
        n = [ring * sides + k, ring * sides + (k + 1) % sides]
        deck.shell.append((1, [1 + n[0], 1 + n[1], 1 + n[1] + sides, 1 + n[0] + sides], t))
axes = np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]], float)  # along, aside, towards the side that is hit

failed = 0


def check(name, found, expected, tolerance):
    global failed
    ok = abs(found / expected - 1) < tolerance
    failed += not ok
    print(f"{'ok' if ok else 'FAILED'}: {name}: {found:.6g}, expected {expected:.6g} within {100 * tolerance:g} %")


for bone_area, inertia in ((True, math.pi / 4 * (R**4 - r**4)), (False, math.pi * R * (R**3 - r**3) / 3)):
    section = tool.slice_of(tool.fibres(deck, "right.tube", axes, bone_area), 10, 30)
    name = "area in the bone" if bone_area else "area of the reference surface"
    check("EI, " + name, tool.stiffness(section), e * inertia, 0.01)
    if bone_area:
        moment, _ = tool.breaking_moment(section, 50 * sigy / e, 0)
        check("fully plastic moment", moment, 4 / 3 * sigy * (R**3 - r**3), 0.01)
        moment, curvature = tool.breaking_moment(section, 0.9 * sigy / e, 0)
        check("moment over curvature below yield", moment / curvature, e * inertia, 0.01)
law = tool.Law(17, 0.3, 0.118, 0.95, 0.36, 4.6)
check("yield at 1.3 /s", law.stress(np.array([0.118 * 1.2947 / 17]), 0.0013)[0],
      0.118 * (1 + (0.0013 / 0.36) ** (1 / 4.6)), 0.001)
sys.exit(failed > 0)
