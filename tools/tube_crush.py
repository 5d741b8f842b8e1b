#!/usr/bin/env python3
"""Writes the mesh of cases/tube-crush: a square tube of shells under a rigid block of bricks.

The walls carry a small fold near the top (amplitude AMPLITUDE over one half wave FOLD), inwards on two opposite
walls and outwards on the other two, so that the tube begins to fold there and goes on fold by fold.
Units: mm. Run from anywhere: python3 tools/tube_crush.py
"""
import math
import pathlib

SIDE, LENGTH, SIZE = 60.0, 300.0, 4.0  # middle surface, tube length, shell size
BLOCK, BLOCK_HEIGHT, BLOCK_SIZE = 100.0, 20.0, 10.0
GAP = 1.0  # from the tube's upper edge to the block; half a wall is taken up by the shell's thickness
AMPLITUDE, FOLD, FOLD_BOTTOM = 0.8, 36.0, 244.0
TUBE, BLOCK_PART = 1, 2
END_SET, BLOCK_NODE = 1, 10001


def wall_offset(along, z):
    """Outward offset of a wall at distance `along` from its middle."""
    s = (z - FOLD_BOTTOM) / FOLD
    if s <= 0 or s >= 1:
        return 0.0
    return AMPLITUDE * math.cos(math.pi * along / SIDE) * math.sin(math.pi * s)


def ring_point(i, per_side, z):
    """Point i of the ring at height z, counter-clockwise from the corner (-,-)."""
    wall, k = divmod(i, per_side)
    along = -SIDE / 2 + SIDE * k / per_side
    out = SIDE / 2 + (wall_offset(along, z) if wall % 2 == 0 else -wall_offset(along, z))
    return [(along, -out), (out, along), (-along, out), (-out, -along)][wall]


def node_line(number, x, y, z):
    return f"{number:8d}{x:16.8f}{y:16.8f}{z:16.8f}"


def tube():
    per_side = round(SIDE / SIZE)
    around, rows = 4 * per_side, round(LENGTH / SIZE)
    nodes, shells = [], []
    for row in range(rows + 1):
        z = LENGTH * row / rows
        for i in range(around):
            nodes.append(node_line(1 + row * around + i, *ring_point(i, per_side, z), z))
    for row in range(rows):
        for i in range(around):
            a, b = 1 + row * around + i, 1 + row * around + (i + 1) % around
            number = 1 + row * around + i
            shells.append("".join(f"{n:8d}" for n in (number, TUBE, a, b, b + around, a + around)))
    return nodes, shells, list(range(1, around + 1))


def block():
    n, layers = round(BLOCK / BLOCK_SIZE), round(BLOCK_HEIGHT / BLOCK_SIZE)
    nodes, solids = [], []

    def number(i, j, k):
        return BLOCK_NODE + (k * (n + 1) + j) * (n + 1) + i

    for k in range(layers + 1):
        for j in range(n + 1):
            for i in range(n + 1):
                x, y = -BLOCK / 2 + i * BLOCK_SIZE, -BLOCK / 2 + j * BLOCK_SIZE
                nodes.append(node_line(number(i, j, k), x, y, LENGTH + GAP + k * BLOCK_SIZE))
    for k in range(layers):
        for j in range(n):
            for i in range(n):
                corners = [number(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                element = BLOCK_NODE + len(solids)
                solids.append("".join(f"{v:8d}" for v in (element, BLOCK_PART, *corners)))
    return nodes, solids


def rows_of(values, per_line=8):
    return ["".join(f"{v:10d}" for v in values[i:i + per_line]) for i in range(0, len(values), per_line)]


def main():
    tube_nodes, shells, lower_end = tube()
    block_nodes, solids = block()
    lines = ["*KEYWORD", "$ written by tools/tube_crush.py; change that, not this", "*NODE"]
    lines += tube_nodes + block_nodes
    lines += ["*ELEMENT_SHELL"] + shells + ["*ELEMENT_SOLID"] + solids
    lines += ["*SET_NODE_LIST", f"{END_SET:10d}"] + rows_of(lower_end) + ["*END"]
    folder = pathlib.Path(__file__).resolve().parent.parent / "cases" / "tube-crush"
    (folder / "mesh.k").write_text("\n".join(lines) + "\n")
    print(f"{len(tube_nodes) + len(block_nodes)} nodes, {len(shells)} shells, {len(solids)} solids")


if __name__ == "__main__":
    main()
