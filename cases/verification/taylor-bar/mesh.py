"""Writes the mesh of a quarter of the Taylor bar: python3 mesh.py [--tets] > mesh.k

Radius 3.2 mm, length 32.4 mm, axis z, base at z = 0. The quarter disc is three blocks of
n x n quadrilaterals that meet at an inner square with bulged sides. --tets splits each
hexahedron into six tetrahedra around its main diagonal.
"""
import math
import sys

RADIUS, LENGTH = 3.2, 32.4


def disc(n):
    """Points and quadrilaterals of the quarter disc."""
    points, index, quads = [], {}, []

    def node(x, y):
        key = (round(x, 9), round(y, 9))
        if key not in index:
            index[key] = len(points)
            points.append((x, y))
        return index[key]

    half, corner = 0.5 * RADIUS, 0.42 * RADIUS

    def inner(a, b):  # a, b in 0..1: bilinear square with its far corner pulled in
        x = a * (1 - b) * half + a * b * corner
        y = b * (1 - a) * half + a * b * corner
        return x, y

    def outer(side, t, r):  # from the square's side at r = 0 to the circle at r = 1
        angle = t * math.pi / 4 if side == 0 else math.pi / 2 - t * math.pi / 4
        x0, y0 = inner(1, t) if side == 0 else inner(t, 1)
        x1, y1 = RADIUS * math.cos(angle), RADIUS * math.sin(angle)
        return x0 + r * (x1 - x0), y0 + r * (y1 - y0)

    for j in range(n):
        for i in range(n):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            quads.append([node(*inner(a / n, b / n)) for a, b in corners])
            quads.append([node(*outer(0, b / n, a / n)) for a, b in corners])
            quads.append([node(*outer(1, b / n, a / n)) for a, b in reversed(corners)])
    return points, quads


def main():
    tets = "--tets" in sys.argv
    n, layers = 3, 50
    points, quads = disc(n)
    print("*KEYWORD\n*NODE")
    for k in range(layers + 1):
        for i, (x, y) in enumerate(points):
            # fixed on the planes of symmetry x = 0 and y = 0
            code = (1 if abs(x) < 1e-9 else 0) + (2 if abs(y) < 1e-9 else 0)
            tc = {0: 0, 1: 1, 2: 2, 3: 4}[code]
            z = LENGTH * k / layers
            print(f"{k * len(points) + i + 1:8d}{x:16.9f}{y:16.9f}{z:16.9f}{tc:8d}{0:8d}")
    print("*ELEMENT_SOLID")
    element = 0
    for k in range(layers):
        for q in quads:
            low = [k * len(points) + i + 1 for i in q]
            c = low + [i + len(points) for i in low]
            parts = [c]
            if tets:
                ring = [1, 2, 3, 7, 4, 5]  # the closed path of edges around the diagonal 0-6
                parts = [[c[0], c[ring[m]], c[ring[(m + 1) % 6]]] + [c[6]] * 5 for m in range(6)]
            for p in parts:
                element += 1
                print(f"{element:8d}{1:8d}" + "".join(f"{i:8d}" for i in p))
    print("*END")


main()
