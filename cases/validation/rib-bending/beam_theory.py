#!/usr/bin/env python3
"""Ribs of a rig as curved beams: beam_theory.py DECK, a deck of `fabrica body --trial rig.toml` at coarse.

Stiffness [N/mm] of each rib between its pots by linear beam theory, to be held beside the run: what the sections of the mesh, its
centre-line and the elastic moduli give, without elements. Per section between two rings of nodes: shells of thickness t under the
edges of the polygon, bricks inside. With the 6 x 6 flexibility of the free length at the anterior pivot, f = sum of

    A^T c A ds,   c = diag(1/EA, 1/GA', 1/GA', 1/GJ) and the inverse of the bending stiffness,   A: section forces of unit loads,

both pots rigid, a unit shortening along x, the line of the pivots, which are free about z: five equations for Fx, Fz, Mx, My and the
turn of the posterior pot.

Then the moment [N m] in the plane at which the outermost fibre of each section reaches the strain at fracture, by the stress of the coupons
at the rate of their test (cortex alone, plane sections, no axial force): mean, least, greatest over the free length; and the depth of the
sections in the plane.
"""
import math
import pathlib
import re
import sys


def cards(path):
    block = []
    for line in open(path):
        if line.startswith("*"):
            if block:
                yield block
            block = [line.split()[0]]
        elif not line.startswith("$"):
            block.append([line[i:i + 20].strip() for i in range(0, len(line.rstrip("\n")), 20)])
    yield block


def add(a, b, s=1.0): return [p + s * q for p, q in zip(a, b)]
def dot(a, b): return sum(p * q for p, q in zip(a, b))
def cross(a, b): return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
def mean(points): return [sum(p[k] for p in points) / len(points) for k in range(3)]
def unit(a): return [p / math.sqrt(dot(a, a)) for p in a]


def solve(matrix, right):
    rows = [list(r) + [b] for r, b in zip(matrix, right)]
    n = len(rows)
    for i in range(n):
        p = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[p] = rows[p], rows[i]
        for r in range(n):
            if r != i:
                q = rows[r][i] / rows[i][i]
                rows[r] = [a - q * b for a, b in zip(rows[r], rows[i])]
    return [rows[i][n] / rows[i][i] for i in range(n)]


class Section:
    """area [mm2] of bone and cortex, EA, bending stiffness about (y, z), GJ, centroid of one slice of a rib"""

    def __init__(self, corners, thickness, axis, E, core):
        middle = mean(corners)
        self.x = unit(axis)
        self.y = unit(cross([0, 0, 1], self.x))
        self.z = cross(self.x, self.y)
        p = [(dot(add(c, middle, -1), self.y), dot(add(c, middle, -1), self.z)) for c in corners]
        edges = [(p[i], p[(i + 1) % len(p)], thickness[i]) for i in range(len(p))]
        self.area = 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b, _ in edges)
        if self.area < 0:
            self.area, edges = -self.area, [(b, a, t) for a, b, t in reversed(edges)]
        self.cortex, first, second, around = 0.0, [0.0, 0.0], [0.0, 0.0, 0.0], 0.0
        for a, b, t in edges:
            d = (b[0] - a[0], b[1] - a[1])
            length = math.hypot(*d)
            inward = (-d[1] / length, d[0] / length)
            m = [0.5 * (a[k] + b[k]) + 0.5 * t * inward[k] for k in (0, 1)]
            area = E * t * length
            self.cortex += t * length
            around += length / t
            first = [first[k] + area * m[k] for k in (0, 1)]
            for n, (i, j) in enumerate(((0, 0), (1, 1), (0, 1))):
                second[n] += area * (m[i] * m[j] + d[i] * d[j] / 12 + inward[i] * inward[j] * t * t / 12)
            q = core * (a[0] * b[1] - b[0] * a[1])
            first = [first[k] + q * (a[k] + b[k]) / 6 for k in (0, 1)]
            for n, (i, j) in enumerate(((0, 0), (1, 1), (0, 1))):
                second[n] += q / 24 * (2 * a[i] * a[j] + 2 * b[i] * b[j] + a[i] * b[j] + b[i] * a[j])
        self.fibres = [(a[0] + (i + 0.5) / 4 * (b[0] - a[0]) + (j + 0.5) / 4 * t * (a[1] - b[1]) / math.dist(a, b), t * math.dist(a, b) / 16)
                       for a, b, t in edges for i in range(4) for j in range(4)]  # place in the plane, area
        self.ends = min(a[0] for a, _, _ in edges), max(a[0] for a, _, _ in edges)
        self.EA = E * self.cortex + core * self.area
        g = [f / self.EA for f in first]
        self.centre = add(add(middle, self.y, g[0]), self.z, g[1])
        self.bending = [second[n] - self.EA * g[i] * g[j] for n, (i, j) in enumerate(((0, 0), (1, 1), (0, 1)))]
        self.GJ = E / 2.6 * 4 * self.area ** 2 / around
        self.GA = E / 2.6 * 0.5 * self.cortex

    def strength(self, stress, strain):
        """moment in the plane [kN mm] at which the outermost fibre reaches `strain`"""
        low, high = self.ends
        for _ in range(50):  # of the neutral axis
            axis = 0.5 * (low + high)
            turn = strain / max(self.ends[1] - axis, axis - self.ends[0])
            if sum(stress(turn * (y - axis)) * area for y, area in self.fibres) > 0:
                low = axis
            else:
                high = axis
        return sum(stress(turn * (y - axis)) * area * (y - axis) for y, area in self.fibres)

    def compliance(self, force, moment):
        """strain and turn per length, in space, from force and moment on the section"""
        N, Qy, Qz = (dot(force, a) for a in (self.x, self.y, self.z))
        T, My, Mz = (dot(moment, a) for a in (self.x, self.y, self.z))
        a, b, c = self.bending  # E y y, E z z, E y z; strain = z ky - y kz
        ky, kz = solve([[b, -c], [-c, a]], [My, Mz])
        strain = add(add([N / self.EA * k for k in self.x], self.y, Qy / self.GA), self.z, Qz / self.GA)
        return strain, add(add([T / self.GJ * k for k in self.x], self.y, ky), self.z, kz)


class Rib:
    def __init__(self, deck, number, E, core):
        nodes, bricks, shells, pots = deck
        rigs = [[n for b in bricks if b[1] == part for n in b[2:]] for part in sorted({b[1] for b in bricks if b[1] > 8000000})]
        part = sorted({b[1] for b in bricks})[number]
        own = [b for b in bricks if b[1] == part]
        first = min(n for b in own for n in b[2:])
        per_ring = own[0][6] - own[0][2]
        count = (max(n for b in own for n in b[2:]) - first + 1) // per_ring
        ring = lambda n: (n - first) // per_ring
        mine = [i for i, p in enumerate(pots) if any(ring(n) in range(count) for n in p)]
        self.pivot = sorted(mean([nodes[n] for n in rigs[i]]) for i in mine)
        line = add(self.pivot[1], self.pivot[0], -1)
        cosine, sine = line[0] / math.hypot(*line[:2]), line[1] / math.hypot(*line[:2])
        turned = lambda x: [cosine * x[0] + sine * x[1], cosine * x[1] - sine * x[0], x[2]]
        self.pivot = list(map(turned, self.pivot))
        shell_part = sorted({s[1] for s, _ in shells})[number]
        edges = {}
        for s, t in shells:
            low = min(map(ring, s[2:]))
            pair = [n - first - low * per_ring for n in s[2:] if ring(n) == low]
            if s[1] == shell_part and len(pair) == 2:
                edges.setdefault(low, []).append((*pair, t))
        at = lambda i, k: turned(nodes[first + i * per_ring + k])
        self.slices = []
        for i in range(count - 1):
            order, thick, left = [edges[i][0][0]], [], list(edges[i])
            while left:
                e = next(e for e in left if order[-1] in e[:2])
                left.remove(e)
                thick.append(e[2])
                order.append(e[1] if e[0] == order[-1] else e[0])
            corners = [[0.5 * (p + q) for p, q in zip(at(i, k), at(i + 1, k))] for k in order[:-1]]
            ends = [mean([at(j, k) for k in order[:-1]]) for j in (i, i + 1)]
            section = Section(corners, thick, add(ends[1], ends[0], -1), E, core)
            shift = add(section.centre, mean(ends), -1)
            self.slices.append((section, add(ends[0], shift), add(ends[1], shift)))
        held = {i for p in mine for i in range(count) if sum(ring(n) == i for n in pots[p]) >= 0.6 * per_ring}
        self.free = [s for i, s in enumerate(self.slices) if not (i in held and i + 1 in held)]

    def stiffness(self, rise=0.0):
        """[kN/mm]; rise: of both pivots along y [mm]"""
        post, ant = sorted(([p[0], p[1] + rise, p[2]] for p in self.pivot), key=lambda p: p[0])
        f = [[0.0] * 6 for _ in range(6)]
        points = [(0.5 - math.sqrt(0.15), 5 / 18), (0.5, 8 / 18), (0.5 + math.sqrt(0.15), 5 / 18)]
        loads = [[float(i == k) for k in range(6)] for i in range(6)]
        for section, a, b in self.free:
            length = math.dist(a, b)
            for t, w in points:
                arm = add(ant, add(a, add(b, a, -1), t), -1)
                inside = [(q[:3], add(q[3:], cross(arm, q[:3]))) for q in loads]
                for j in range(6):
                    strain, turn = section.compliance(*inside[j])
                    for i in range(6):
                        f[i][j] += length * w * (dot(inside[i][0], strain) + dot(inside[i][1], turn))
        # unknown Fx, Fz, Mx, My and the turn of the posterior pot about z; Fy = 0 (no moment on its pivot), Mz = 0
        loaded, turned = (0, 2, 3, 4), cross([0, 0, 1], add(ant, post, -1))
        rows = [[f[i][j] for j in loaded] + [turned[i] if i < 3 else 0.0] for i in (0, 1, 2, 3, 4)]
        return -solve(rows, [-1.0, 0, 0, 0, 0])[0]


def read(path):
    nodes, bricks, shells, pots = {}, [], [], []
    for block in cards(path):
        if block[0] == "*NODE":
            nodes = {int(r[0]): [float(v) for v in r[1:4]] for r in block[1:]}
        elif block[0] == "*ELEMENT_SOLID":
            bricks = [[int(v) for v in r[:10]] for r in block[1:]]
        elif block[0] == "*ELEMENT_SHELL_THICKNESS":
            shells = [([int(v) for v in a[:6]], float(b[0])) for a, b in zip(block[1::2], block[2::2])]
        elif block[0] == "*SET_NODE_LIST_TITLE":
            pots.append([int(v) for r in block[3:] for v in r if v and int(v)])
    return nodes, bricks, shells, pots


def field(row, name):
    """of a row of data/materials.csv"""
    table = pathlib.Path(__file__).parents[3] / "data" / "materials.csv"
    line = next(l for l in table.read_text(encoding="utf-8").splitlines() if l.startswith(row + ","))
    return float(re.search(rf"\b{name}=([0-9.]+)", line).group(1))


def coupon_law():
    """stress [GPa] over strain of the cortex of ribs at 0.5 1/s"""
    E, yielded, at, plastic, C, P = (field("rib_cortical", f) for f in ("e", "es1", "es2", "eps2", "c", "p"))
    rate = 1 + (0.0005 / C) ** (1 / P)
    slope, yielded = rate * (at - yielded) / plastic, rate * yielded
    return lambda e: math.copysign(min(E * abs(e), (abs(e) + yielded / slope) / (1 / E + 1 / slope)), e)


def main():
    deck = read(sys.argv[1])
    E, core = field("rib_cortical", "e"), field("rib_trabecular", "e")
    stress = coupon_law()
    for number in range(len({s[1] for s, _ in deck[2]})):
        rib = Rib(deck, number, E, core)
        middle = [s for s, _, _ in rib.free]
        average = lambda of: sum(map(of, middle)) / len(middle)
        print(f"rib {number + 1} of the deck: {1000 * rib.stiffness():.2f} N/mm, pivots 5 mm higher "
              f"{1000 * rib.stiffness(5):.2f}, lower {1000 * rib.stiffness(-5):.2f}; area {average(lambda s: s.area):.0f} mm2, "
              f"cortex {average(lambda s: s.cortex):.1f} mm2, E I in the plane {average(lambda s: s.bending[0]):.0f} kN mm2")
        moment = [s.strength(stress, 0.027) for s in middle]
        depth = [s.ends[1] - s.ends[0] for s in middle]
        print(f"  breaks at {sum(moment) / len(moment):.1f} ({min(moment):.1f} to {max(moment):.1f}) N m, {min(depth):.1f} to {max(depth):.1f} mm deep")


if __name__ == "__main__":
    main()
