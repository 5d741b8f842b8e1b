#!/usr/bin/env python3
"""Makes the shipped bone tables from the full ones: tools/thin_anatomy.py FOLDER data/anatomy/bones

FOLDER holds the full tables (index.csv, *_stack.csv, *_loft.csv, skull_vault_sh.csv, cortical_thickness.csv, ...).
Shipped is the thinned form: contours keep at most 6 harmonics, slices and stations are taken 1.6 spacings apart
(the nearest ones that exist, first and last always). Vertebrae change within a slice at their endplates and at the roots of
arch and processes: of them so many slices are kept, where the outline changes most, that no slice left out is off by more
than 0.5 mm in the mean (slice_choice.py). Bones of the arm keep slices beside those 1.6 spacings apart by the same rule: a joint's
face lies between two slices, and half of it goes with one that is left out. So no surface can be recovered finer than 0.5-0.75 mm. Printed is, for each
stack, how many slices stay and the largest error of those left out; numpy is needed for that.
Only what the mesh makers read is written. The result depends on the input alone.

Ribs of data/anatomy/rib_arches.csv get the arch of the mean man: with h the height of the centre-line over the line of its
ends, in the rib's plane, each point moves along h by

    (k - 1) w(s) h,   k = (rise / span of the table) span / max h,   w = 0 up to the tubercle, 1 from there on smoothly,

sections turn with the tangent, ends stay where they are; volume and box in index.csv follow. Shafts of
data/anatomy/shaft_sections.csv get the size of the mean man (shaft_sections.py), and the volume in index.csv follows.
"""
import csv
import math
import pathlib
import re
import sys

import shaft_sections
import slice_choice

HARMONICS = 6
SPACING = 1.6
# stacks whose slices are chosen by what they change, and the largest error of a slice left out [mm]
CHOSEN = re.compile(r"[CTL]\d+")
BOUND = 0.5
ADDED = re.compile(r"humerus|radius|ulna")  # stacks that keep more slices than those 1.6 spacings apart, by the same bound
VAULT_DEGREE = 10  # a smooth fit; a lower degree leaves waves of 1.5 mm on the crown
# the slices of the skull are 4.9 mm apart: its table is already coarser (0.7 mm) than the thinned form of the others
WHOLE = {"skull"}
ARCHES = pathlib.Path(__file__).resolve().parents[1] / "data" / "anatomy" / "rib_arches.csv"
NOTICE = ("# Dimensions measured from BodyParts3D, (c) The Database Center for Life Science, CC BY-SA 4.0; changes: scaled"
          " per region, reduced to cross-section fits, thinned. See LICENSE in data/anatomy.\n")
# bones meshed from their lofts (no stack, or a shape that sections describe better)
LOFTS = re.compile(r"rib\d+|costal_cartilage\d+|manubrium|sternum_body|xiphoid|fibula|hand_rays|foot_rays")


def read(path):
    """(comment lines, list of row dictionaries) of a table"""
    lines = path.read_text(encoding="utf-8").splitlines()
    comments = [line for line in lines if line.startswith("#")]
    return comments, list(csv.DictReader(line for line in lines if not line.startswith("#")))


def write(path, comment, columns, rows, notice=NOTICE):
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.write(notice + comment)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)


def kept(count):
    """indices of the slices that stay: the nearest to multiples of SPACING, with both ends"""
    steps = max(min(count - 1, 4), round((count - 1) / SPACING))
    return sorted({round(i * (count - 1) / steps) for i in range(steps + 1)})


def number(text):
    return f"{float(text):.2f}".rstrip("0").rstrip(".")


def vector(text, name):
    return [number(v) for v in re.search(name + r"=\(([^)]*)\)", text)[1].split()]


def stack_of(rows, heights):
    """the stack of contours as they would be shipped, all slices of it"""
    def part(row, name):
        return float(row.get(name, 0))

    slices = {height: [] for height in heights}
    for row in rows:
        coefficients = {k: complex(part(row, f"re{k}"), part(row, f"im{k}")) for k in range(-HARMONICS, HARMONICS + 1)}
        slices[part(row, "s_mm")].append(slice_choice.outline(coefficients))
    return slice_choice.Stack(list(slices.items()))


def slices_kept(bone, rows, heights):
    """indices of the slices that stay"""
    if bone in WHOLE:
        return range(len(heights))
    stack, even = stack_of(rows, heights), kept(len(heights))
    keep = stack.choice(BOUND) if CHOSEN.fullmatch(bone) else stack.choice(BOUND, even) if ADDED.fullmatch(bone) else even
    line = f"{bone}: {len(keep)} of {len(heights)} slices, largest error of the others {stack.largest(keep)[0]:.2f} mm"
    if keep is not even:
        line += f" (1.6 spacings apart: {len(even)} slices, {stack.largest(even)[0]:.2f} mm)"
    print(line)
    return keep


def thin_stack(source, target, box):
    comments, rows = read(source)
    bone = source.name.removesuffix("_stack.csv")
    sized = shaft_sections.sized(bone, rows, *box)
    said = "" if sized is rows else "# shaft of the size of data/anatomy/shaft_sections.csv\n"
    rows = sized
    heights = sorted({float(row["s_mm"]) for row in rows})
    keep = {heights[i] for i in slices_kept(bone, rows, heights)}
    orders = range(-HARMONICS, HARMONICS + 1)
    columns = ["height", "sign"] + [f"{part}{k}" for k in orders for part in ("re", "im")]
    out = [[number(row["s_mm"]), int(row["sign"])] + [number(row[f"{part}{k}"]) for k in orders for part in ("re", "im")]
           for row in rows if float(row["s_mm"]) in keep]
    write(target, said + "# closed contours z(t) = sum_k (re_k + i im_k) exp(i k t) of parallel slices [mm]; sign +1 outer, -1 hole\n",
          columns, out)
    return vector(comments[0], "normal n"), vector(comments[0], "e1")


def unfolded(stations):
    """stations of a centre-line that does not run back on itself: where the given one does (two costal cartilages), the
    sections across the mean direction, in order along it, none closer than 3 mm to the one before"""
    def part(row, name):
        return [float(row[name + axis + suffix]) for axis, suffix in zip("xyz", ["_mm"] * 3 if name == "c" else [""] * 3)]

    normals = [part(row, "n") for row in stations]
    if all(dot(a, b) > 0 for a, b in zip(normals, normals[1:])):
        return stations
    axis = normals[0]
    for _ in range(3):
        total = [sum(n[i] if dot(n, axis) > 0 else -n[i] for n in normals) for i in range(3)]
        axis = [v / dot(total, total) ** 0.5 for v in total]
    result = []
    for row, n in sorted(zip(stations, normals), key=lambda pair: dot(part(pair[0], "c"), axis)):
        if abs(dot(n, axis)) < 0.85 or (result and dot(part(row, "c"), axis) - dot(part(result[-1], "c"), axis) < 3):
            continue
        if dot(n, axis) < 0:  # seen from the other side phi runs backwards
            row = {k: str(-float(v)) if re.fullmatch(r"n[xyz]|s\d_mm", k) else v for k, v in row.items()}
        result.append(row)
    return result


def add(a, b, factor=1.0):
    return [x + factor * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def lengths(points):
    """length of the line through points up to each of them"""
    total = [0.0]
    for a, b in zip(points, points[1:]):
        total.append(total[-1] + math.dist(a, b))
    return total


def tangents(points):
    """of parabolas through neighbouring points"""
    s, result = lengths(points), []
    for i in range(len(points)):
        j = min(max(i, 1), len(points) - 2)
        (a, b, c), x = s[j - 1:j + 2], s[i]
        parts = ((2 * x - b - c) / ((a - b) * (a - c)), (2 * x - a - c) / ((b - a) * (b - c)), (2 * x - a - b) / ((c - a) * (c - b)))
        result.append(unit([sum(w * p[k] for w, p in zip(parts, points[j - 1:j + 2])) for k in range(3)]))
    return result


def turned(vector, a, b):
    """vector turned by the smallest rotation from unit vector a to b"""
    axis, cosine = cross(a, b), dot(a, b)
    return add(add([cosine * v for v in vector], cross(axis, vector)), axis, dot(axis, vector) / (1 + cosine))


def arches():
    _, rows = read(ARCHES)
    return {row["bone"]: (float(row["rise_over_span"]), float(row["tubercle_mm"])) for row in rows}


def arched(stations, rise_over_span, tubercle):
    """stations of a rib with the given rise over the line of its ends (head of this file)"""
    def part(row, names):
        return [float(row[name]) for name in names]

    centre, normal, e1 = ["cx_mm", "cy_mm", "cz_mm"], ["nx", "ny", "nz"], ["e1x", "e1y", "e1z"]
    old = [part(row, centre) for row in stations]
    span, along = math.dist(old[0], old[-1]), unit(add(old[-1], old[0], -1))
    offsets = [add(add(p, old[0], -1), along, -dot(add(p, old[0], -1), along)) for p in old]
    up = unit([sum(o[k] for o in offsets) for k in range(3)])
    heights = [dot(o, up) for o in offsets]
    k = rise_over_span * span / max(heights)
    new = []
    for p, h, s in zip(old, heights, lengths(old)):
        t = min(max((s - tubercle) / (2 * tubercle), 0), 1)
        new.append(add(p, up, (k - 1) * t * t * (3 - 2 * t) * h))
    result = []
    for row, p, a, b in zip(stations, new, tangents(old), tangents(new)):
        fields = p + turned(part(row, normal), a, b) + turned(part(row, e1), a, b)
        result.append(row | {name: repr(v) for name, v in zip(centre + normal + e1, fields)})
    return result


def change_of(stations, arch):
    """factor of the volume of a rib by its arch, and how far the ends of its box move"""
    def points(rows):
        return [[float(row[f"c{axis}_mm"]) for axis in "xyz"] for row in rows]

    def volume(line):
        return sum(0.5 * (float(a["area_mm2"]) + float(b["area_mm2"])) * math.dist(p, q)
                   for a, b, p, q in zip(stations, stations[1:], line, line[1:]))

    old, new = points(stations), points(arched(stations, *arch))
    moves = [end(p[k] for p in new) - end(p[k] for p in old) for end in (min, max) for k in range(3)]
    return volume(new) / volume(old), moves


def thin_loft(source, target):
    _, rows = read(source)
    arch = arches().get(source.name.removesuffix("_loft.csv"))
    if arch:
        rows = arched(rows, *arch)
    fields = ["cx_mm", "cy_mm", "cz_mm", "nx", "ny", "nz", "e1x", "e1y", "e1z", "r0_mm"]
    waves = [f"{part}{k}_mm" for k in range(1, HARMONICS + 1) for part in ("c", "s")]
    pieces = {}
    for row in rows:
        pieces.setdefault(row["piece"], []).append(row)
    out = []
    for piece, stations in pieces.items():
        stations = unfolded(stations)
        for i in kept(len(stations)):
            row = stations[i]
            directions = [f"{float(row[f]):.4f}" for f in fields[3:9]]
            out.append([piece] + [number(row[f]) for f in fields[:3]] + directions +
                       [number(row["r0_mm"])] + [number(row[w]) for w in waves])
    raised = "# centre-line raised to the arch of data/anatomy/rib_arches.csv\n" if arch else ""
    write(target, raised + "# sections r(phi) = r0 + sum_k c_k cos k phi + s_k sin k phi in the plane through c with normal n;"
          " phi from e1 towards n x e1 [mm]\n", ["piece"] + [c.replace("_mm", "") for c in fields + waves], out)


def constructed_cartilages(source, target):
    """elliptical cartilages 8-10 stay as they are: they were constructed, not measured"""
    _, rows = read(source)
    out = [[row["piece"]] + [number(row[c]) for c in ("cx_mm", "cy_mm", "cz_mm", "a_mm", "b_mm")] for row in rows]
    write(target, "", ["piece", "cx", "cy", "cz", "a", "b"], out,
          "# constructed, not measured: curves from the anterior end of a rib to the cartilage above; elliptical half\n"
          "# widths a (along the body's length) and b (across) [mm]\n")


def vault(source, target):
    _, rows = read(source)
    out = [[row["l"], row["m"]] + [f"{float(row[c]):.3f}" for c in ("outer_mm", "inner_am50_mm")] for row in rows
           if int(row["l"]) <= VAULT_DEGREE]
    write(target, "# real orthonormal spherical harmonics of the vault's radius about (8.20, 0, 84.67) in frame head [mm];\n"
          "# theta from +z, phi from +x to +y, no Condon-Shortley phase, m < 0 sine, m > 0 cosine; outer: external table,\n"
          "# inner: endocranial surface for literature thickness\n", ["l", "m", "outer", "inner"], out)


def thickness(source, target):
    _, rows = read(source)
    out = []
    for row in rows:
        if row["where"].startswith("fraction"):
            bone, where = row["bone_or_region"], row["where"].split()[1]
        elif row["where"] in ("cortex", "total", "layer"):
            bone, where = row["bone_or_region"], row["where"]
        else:
            continue
        if re.fullmatch(r"[\d.]+", row["value_mm"]):
            out.append([bone, where, row["value_mm"], row["confidence"]])
    write(target, "", ["region", "where", "thickness", "source"], out,
          "# thickness of cortex and layers [mm]; where: a number is the fraction of the length (long bones: 0 distal, 1\n"
          "# proximal; ribs: 0 head, 1 anterior end; clavicle: 0 sternal). Typical adult values; the source column says whence\n")


def index(source, target, planes):
    _, rows = read(source)
    out = []
    for row in rows:
        arch = arches().get(row["bone"])
        if arch:
            _, stations = read(source.parent / f"{row['bone']}_loft.csv")
            factor, moves = change_of(stations, arch)
            row["volume_cm3"] = number(float(row["volume_cm3"]) * factor)
            for name, move in zip(("xmin", "ymin", "zmin", "xmax", "ymax", "zmax"), moves):
                row[name] = number(float(row[name]) + move)
        if shaft_sections.sections(row["bone"]):
            _, slices = read(source.parent / f"{row['bone']}_stack.csv")
            ends = float(row["zmin"]), float(row["zmax"])
            factor = shaft_sections.volume(shaft_sections.sized(row["bone"], slices, *ends)) / shaft_sections.volume(slices)
            row["volume_cm3"] = number(float(row["volume_cm3"]) * factor)
        n, e1 = planes.get(row["bone"], (["", "", ""], ["", "", ""]))
        out.append([row["bone"], row["frame"], row["volume_cm3"]] +
                   [row[c] for c in ("xmin", "ymin", "zmin", "xmax", "ymax", "zmax")] + n + e1)
    write(target, "# volume [cm3] and box [mm] of the measured bone; slices: normal n, first axis e1 (second n x e1)\n",
          ["bone", "frame", "volume", "xmin", "ymin", "zmin", "xmax", "ymax", "zmax", "nx", "ny", "nz", "e1x", "e1y", "e1z"], out)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, target = map(pathlib.Path, sys.argv[1:])
    target.mkdir(parents=True, exist_ok=True)
    planes = {}
    boxes = {row["bone"]: (float(row["zmin"]), float(row["zmax"])) for row in read(source / "index.csv")[1]}
    for path in sorted(source.glob("*_stack.csv")):
        bone = path.name.removesuffix("_stack.csv")
        planes[bone] = thin_stack(path, target / path.name, boxes[bone])
    for path in sorted(source.glob("*_loft.csv")):
        if LOFTS.fullmatch(path.name.removesuffix("_loft.csv")):
            thin_loft(path, target / path.name)
    constructed_cartilages(source / "costal_cartilage8_10_constructed.csv", target / "costal_cartilage8_10_loft.csv")
    vault(source / "skull_vault_sh.csv", target / "skull_vault.csv")
    thickness(source / "cortical_thickness.csv", target / "cortical_thickness.csv")
    index(source / "index.csv", target / "index.csv", planes)


if __name__ == "__main__":
    main()
