#!/usr/bin/env python3
"""Bending of a bone's shaft from the sections of its mesh: stiffness EI, and the moment at which it breaks.

    fabrica body --bones femur --no-joints --out femur.k
    python3 tools/bone_sections.py femur.k right.femur --hit lateral

Bernoulli: strain e = e0 + k z + q y over a section square to the long axis, z towards the side that is hit (compression),
no axial force and no moment about z. Sums over bricks and shells with the laws of the deck:

    S_ij = sum E i j dA about the centroid,  EI = S_zz - S_zy^2 / S_yy
    M(k) = sum s(e) z dA,  broken where |e| reaches the strain at fracture anywhere

s is the slow curve of the law (yield, tangent modulus); with --rate its yield, and its hardening too unless VP is 1, times
1 + (rate / C)^(1/P) in the cortex. Shells are
taken twice: `run` as elements integrate them (area of the reference surface times thickness, layers inward from it),
`bone` with the area that a layer has, narrower the deeper it lies on a curved surface. What is left out: shear, curvature
of the axis, ovalling. `bone` takes the thickness of a shell for the depth of its layer. So this is what mesh and materials
say without the solver.
"""
import argparse

import numpy as np


def blocks(path):
    name, rows = None, []
    for line in open(path):
        if line.startswith("*"):
            if name:
                yield name, rows
            name, rows = line.strip(), []
        elif not line.startswith("$"):
            rows.append(line.rstrip("\n"))
    yield name, rows


class Deck:
    def __init__(self, path):
        self.node, self.solid, self.shell, self.part, self.law = {}, [], [], {}, {}
        self.long = False
        for name, rows in blocks(path):
            self.long = self.long or name.replace(" ", "").endswith("LONG=Y")
            self.read(name, rows)

    def fields(self, row, short):
        width = 20 if self.long else short
        return [row[i:i + width].strip() for i in range(0, len(row), width)]

    def read(self, name, rows):
        if name == "*NODE":
            for r in rows:
                cut = [0, 20, 40, 60, 80] if self.long else [0, 8, 24, 40, 56]
                v = [r[a:b] for a, b in zip(cut, cut[1:])]
                self.node[int(v[0])] = np.array([float(c) for c in v[1:]])
        elif name == "*ELEMENT_SOLID":
            for r in rows:
                v = [int(x) for x in self.fields(r, 8) if x]
                self.solid.append((v[1], v[2:10]))
        elif name == "*ELEMENT_SHELL_THICKNESS":
            for a, b in zip(rows[::2], rows[1::2]):
                v = [int(x) for x in self.fields(a, 8) if x]
                self.shell.append((v[1], v[2:6], float(self.fields(b, 16)[0])))
        elif name == "*PART":
            v = self.fields(rows[1], 10)
            self.part[int(v[0])] = (rows[0].strip(), int(v[2]))
        elif name.startswith("*MAT_") and "RIGID" not in name:
            v = self.fields(rows[1], 10)
            rate = self.fields(rows[2], 10) if "PIECEWISE" in name and len(rows) > 2 else []
            c, p, _, _, vp = (float(x) if x else 0 for x in (rate + 5 * [""])[:5])
            self.law[int(v[0])] = Law(*(float(x) for x in v[2:6]), c, p, vp)

    def of_bone(self, bone, pid):
        return ("." + bone + ".") in ("." + self.part[pid][0] + ".")


class Law:
    """elastic, then a straight line: modulus, Poisson's ratio, yield, tangent modulus; C, P and VP of the rate"""

    def __init__(self, e, nu, sigy, etan, c=0, p=0, vp=0):
        self.e, self.nu, self.sigy, self.etan, self.c, self.p, self.vp = e, nu, sigy, etan, c, p, vp

    def stress(self, strain, rate):
        factor = 1 + (rate / self.c) ** (1 / self.p) if rate > 0 and self.c > 0 else 1
        hard = self.e * self.etan / (self.e - self.etan) * (1 if self.vp == 1 else factor)
        plastic = np.maximum(abs(strain) - factor * self.sigy / self.e, 0) * self.e / (self.e + hard)
        return np.sign(strain) * (self.e * (abs(strain) - plastic))


def brick_points(x, n=4):
    """points of bricks x (brick, corner, 3) and their volumes"""
    corner = np.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1),
                       (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)])
    for r in np.stack(np.meshgrid(*3 * [(np.arange(n) + 0.5) * 2 / n - 1]), -1).reshape(-1, 3):
        f = 1 + corner * r
        slope = np.array([corner[:, k] * f[:, (k + 1) % 3] * f[:, (k + 2) % 3] / 8 for k in range(3)])
        yield np.einsum("c,eci->ei", f.prod(axis=1) / 8, x), np.linalg.det(slope @ x) * (2 / n) ** 3


def surface_normals(x, nodes):
    """unit outward normals at the corners of quads x (quad, corner, 3): means over the quads of a node"""
    flat = np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])
    mean = np.zeros((nodes.max() + 1, 3))
    for k in range(4):
        np.add.at(mean, nodes[:, k], flat)
    mean /= np.maximum(np.linalg.norm(mean, axis=1), 1e-30)[:, None]
    return mean[nodes], flat / np.linalg.norm(flat, axis=1)[:, None]


def shell_points(x, nodes, t, bone_area, n=4, layers=8):
    normal, flat = surface_normals(x, nodes)
    for a, b in np.stack(np.meshgrid(*2 * [(np.arange(n) + 0.5) * 2 / n - 1]), -1).reshape(-1, 2):
        w = np.array([(1 - a) * (1 - b), (1 + a) * (1 - b), (1 + a) * (1 + b), (1 - a) * (1 + b)]) / 4
        da = np.array([-(1 - b), 1 - b, 1 + b, -(1 + b)]) / 4
        db = np.array([-(1 - a), -(1 + a), 1 + a, 1 - a]) / 4
        for k in range(layers):
            depth = (k + 0.5) * t / layers
            y = x - depth[:, None, None] * (normal if bone_area else flat[:, None, :])
            area = np.cross(np.einsum("c,eci->ei", da, y), np.einsum("c,eci->ei", db, y))
            yield np.einsum("c,eci->ei", w, y), np.linalg.norm(area, axis=1) * (2 / n) ** 2 * t / layers


def fibres(deck, bone, axes, bone_area):
    """points of the bone in axes (rows x along, y, z) with volume and law: one list per law"""
    out = {}
    for pid, (_, law) in deck.part.items():
        if not deck.of_bone(bone, pid):
            continue
        bricks = [nodes for part, nodes in deck.solid if part == pid]
        shells = [(nodes, t) for part, nodes, t in deck.shell if part == pid]
        points = []
        if bricks:
            points += brick_points(np.array([[deck.node[n] for n in nodes] for nodes in bricks]) @ axes.T)
        if shells:
            x = np.array([[deck.node[n] for n in nodes] for nodes, _ in shells]) @ axes.T
            nodes, t = np.array([nodes for nodes, _ in shells]), np.array([t for _, t in shells])
            points += shell_points(x, nodes - nodes.min(), t, bone_area)
        if points:
            out.setdefault(law, []).extend(points)
    return [(deck.law[law], np.concatenate([p for p, _ in pts]), np.concatenate([v for _, v in pts]))
            for law, pts in out.items()]


def slice_of(bone_fibres, low, high):
    """fibres of a slice with areas, about its centroid"""
    out = []
    for law, x, volume in bone_fibres:
        ok = (x[:, 0] >= low) & (x[:, 0] < high)
        out.append((law, x[ok, 1], x[ok, 2], volume[ok] / (high - low)))
    ea = sum(law.e * a.sum() for law, _, _, a in out)
    y0 = sum(law.e * (a * y).sum() for law, y, _, a in out) / ea
    z0 = sum(law.e * (a * z).sum() for law, _, z, a in out) / ea
    return [(law, y - y0, z - z0, a) for law, y, z, a in out]


def stiffness(section):
    yy, yz, zz = (sum(law.e * (a * f(y, z)).sum() for law, y, z, a in section)
                  for f in (lambda y, z: y * y, lambda y, z: y * z, lambda y, z: z * z))
    return zz - yz * yz / yy


def resultants(section, strain, rate):
    e0, k, q = strain
    force = moment_z = moment_y = 0
    for law, y, z, a in section:
        s = law.stress(e0 + k * z + q * y, rate) * a
        force, moment_z, moment_y = force + s.sum(), moment_z + (s * z).sum(), moment_y + (s * y).sum()
    return np.array([force, moment_y]), moment_z


def breaking_moment(section, strain_at_fracture, rate, steps=40):
    """moment [kN mm] and curvature [1/mm] at which the outermost fibre of the cortex reaches the strain"""
    cortex = max(section, key=lambda fibre: fibre[0].e)
    reach = max(abs(cortex[2]))
    e0 = q = 0.0
    k = 0.0
    last = (0.0, 0.0)
    for step in range(10 * steps):
        k += strain_at_fracture / reach / steps
        for _ in range(30):  # Newton: no force, no moment about z
            r, moment = resultants(section, (e0, k, q), rate)
            h = 1e-7
            c1 = (resultants(section, (e0 + h, k, q), rate)[0] - r) / h
            c2 = (resultants(section, (e0, k, q + h / reach), rate)[0] - r) / (h / reach)
            d = np.linalg.solve(np.stack([c1, c2], 1), -r)
            e0, q = e0 + d[0], q + d[1]
            if abs(d[0]) + abs(d[1]) * reach < 1e-10:
                break
        if max(abs(e0 + k * cortex[2] + q * cortex[1])) >= strain_at_fracture:
            return moment, k
        last = (moment, k)
    return last


HIT = {"lateral": (0, -1, 0), "medial": (0, 1, 0), "anterior": (1, 0, 0), "posterior": (-1, 0, 0)}


def axes_of(deck, bone, hit):
    """long axis of the bone's nodes, and the side that is hit (of a right bone) made square to it"""
    ids = {n for pid, nodes in deck.solid if deck.of_bone(bone, pid) for n in nodes}
    x = np.array([deck.node[n] for n in ids])
    along = np.linalg.svd(x - x.mean(axis=0), full_matrices=False)[2][0]
    along = along * np.sign(along[2])
    z = np.array(HIT[hit], float)
    z -= (z @ along) * along
    z /= np.linalg.norm(z)
    axes = np.array([along, np.cross(z, along), z])
    reach = x @ along
    return axes, reach.min(), reach.max()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck")
    parser.add_argument("bone")
    parser.add_argument("--hit", choices=HIT, default="lateral", help="side in compression, of a right bone")
    parser.add_argument("--shaft", type=float, nargs=2, default=[0.3, 0.7], help="shares of the length, from below")
    parser.add_argument("--slices", type=int, default=8)
    parser.add_argument("--strain", type=float, default=0.02, help="at fracture")
    parser.add_argument("--rate", type=float, default=0, help="of strain, per ms")
    args = parser.parse_args()
    deck = Deck(args.deck)
    axes, low, high = axes_of(deck, args.bone, args.hit)
    edges = low + (high - low) * np.linspace(*args.shaft, args.slices + 1)
    print(f"{args.bone}: {high - low:.0f} mm long, hit from {args.hit}, strain at fracture {args.strain:g}, "
          f"rate {1000 * args.rate:g} /s")
    for name, bone_area in (("run", False), ("bone", True)):
        all_fibres = fibres(deck, args.bone, axes, bone_area)
        rows = [slice_of(all_fibres, a, b) for a, b in zip(edges, edges[1:])]
        ei = [stiffness(r) for r in rows]
        moment = [breaking_moment(r, args.strain, args.rate)[0] for r in rows]
        middle = len(rows) // 2
        print(f"  {name:4}: EI {min(ei) / 1e3:.0f} to {max(ei) / 1e3:.0f} N m2, middle {ei[middle] / 1e3:.0f}; "
              f"breaks at {min(moment):.0f} to {max(moment):.0f} N m, middle {moment[middle]:.0f}")


if __name__ == "__main__":
    main()
