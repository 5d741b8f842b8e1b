#!/usr/bin/env python3
"""Motion segments of the spine in six directions of moment, ours beside measured: spine_units.py PROGRAM FOLDER [UNIT ...]

Makes each unit with `fabrica body --bones`, holds the lower half of the lower vertebra, makes the upper half of the upper one
rigid, raises a pure moment over 15 ms, holds it to 22 ms with light damping and prints the rotation
of the upper vertebra beside reference.csv.
"""
import csv
import math
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
# degree of freedom of *LOAD_NODE_POINT (5-7: moments about x forward, y left, z up) and sign
DIRECTIONS = {"flexion": (6, 1), "extension": (6, -1), "lateral_left": (5, -1), "lateral_right": (5, 1),
              "axial_left": (7, 1), "axial_right": (7, -1)}
RAMP, END = 15, 22  # [ms]
MOMENT = {"L": 10.0, "T": 7.5, "C": 3.5}  # [N m = kN mm]


def numbers(line, width=20):
    return [line[i:i + width] for i in range(0, len(line.rstrip()), width)]


def read_deck(path):
    """(node -> place, bone -> nodes of its shells) of a deck that the body command wrote"""
    nodes, shells, parts = {}, {}, {}
    block, lines = "", []

    def close():
        if block == "*NODE":
            for line in lines:
                f = numbers(line)
                nodes[int(f[0])] = tuple(float(x) for x in f[1:4])
        elif block.startswith("*PART"):
            for title, card in zip(lines[0::2], lines[1::2]):
                parts[int(card[:20])] = title.strip()
        elif block.startswith("*ELEMENT_SHELL"):
            for line in lines[0::2]:
                f = [int(x) for x in numbers(line)]
                shells.setdefault(f[1], set()).update(f[2:6])

    for line in open(path, encoding="utf-8"):
        if line.startswith("*"):
            close()
            block, lines = line.strip(), []
        elif not line.startswith("$"):
            lines.append(line)
    close()
    bones = {}
    for part, members in shells.items():
        bones.setdefault(parts[part].split(".")[2], set()).update(members)
    return nodes, bones


def node_set(number, members):
    members = sorted(members)
    rows = [members[i:i + 8] for i in range(0, len(members), 8)]
    return f"*SET_NODE_LIST\n{number:10d}\n" + "".join("".join(f"{n:10d}" for n in row) + "\n" for row in rows)


def rig(body, unit, direction, target):
    nodes, bones = read_deck(body)
    upper, lower = unit.split("_")

    def half(bone, above):
        middle = sum(nodes[n][2] for n in bones[bone]) / len(bones[bone])
        return [n for n in bones[bone] if (nodes[n][2] > middle) == above]

    held, turned = half(lower, False), half(upper, True)
    dof, sign = DIRECTIONS[direction]
    moment = sign * MOMENT[unit[0]]
    left, right = min(turned, key=lambda n: nodes[n][1]), max(turned, key=lambda n: nodes[n][1])
    front, back = max(turned, key=lambda n: nodes[n][0]), min(turned, key=lambda n: nodes[n][0])
    target.write_text(
        f"*KEYWORD\n*INCLUDE\n{body.name}\n" + node_set(9001, held) + node_set(9002, turned) +
        "*BOUNDARY_SPC_SET\n" + f"{9001:10d}{0:10d}" + 6 * f"{1:10d}" + "\n" +
        "*CONSTRAINED_NODAL_RIGID_BODY\n" + f"{9000:10d}{0:10d}{9002:10d}\n" +
        f"*LOAD_NODE_POINT\n{left:10d}{dof:10d}{9000:10d}{moment:10.4f}\n" +
        f"*DEFINE_CURVE\n{9000:10d}\n{0:20.1f}{0:20.1f}\n{RAMP:20.1f}{1:20.1f}\n{1000:20.1f}{1:20.1f}\n" +
        f"*DAMPING_GLOBAL\n{0:10d}{0.5:10.2f}\n" +
        "*DATABASE_HISTORY_NODE\n" + "".join(f"{n:10d}" for n in (left, right, front, back)) + "\n" +
        "*DATABASE_NODOUT\n       0.5\n*END\n", encoding="utf-8")
    return nodes, (left, right, front, back)


def rotation(before, after):
    """angle [deg] of the rotation that takes two vectors to two vectors, by their orthonormal frames"""
    def frame(v, w):
        def unit(a):
            s = math.sqrt(sum(x * x for x in a))
            return [x / s for x in a]

        def cross(a, b):
            return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        e1 = unit(v)
        e3 = unit(cross(v, w))
        return e1, cross(e3, e1), e3
    trace = sum(sum(x * y for x, y in zip(a, b)) for a, b in zip(frame(*before), frame(*after)))
    return math.degrees(math.acos(max(-1.0, min(1.0, (trace - 1) / 2))))


def turned(folder, nodes, ids):
    """(last time, rotation [deg] then)"""
    with open(folder / "csv" / "nodout.csv", encoding="utf-8") as file:
        last = list(csv.DictReader(file))[-1]

    def place(n):
        return [nodes[n][i] + float(last[f"{axis}_displacement:{n}"]) for i, axis in enumerate("xyz")]

    def arms(at):
        left, right, front, back = (at(n) for n in ids)
        return [a - b for a, b in zip(left, right)], [a - b for a, b in zip(front, back)]
    return float(last["time"]), rotation(arms(lambda n: nodes[n]), arms(place))


def run(program, folder, unit, direction):
    body = folder / f"{unit}.k"
    if not body.exists():
        subprocess.run([program, "body", "--bones", *unit.split("_"), "--quiet", "--out", body], check=True)
    deck, out = folder / f"{unit}_{direction}.k", folder / f"{unit}_{direction}"
    nodes, ids = rig(body, unit, direction, deck)
    done = subprocess.run([program, "run", deck, "--until", str(END), "--threads", "1", "--quiet", "--out", out],
                          capture_output=True, text=True, check=False)
    if not (out / "csv" / "nodout.csv").exists():
        return 0.0, math.nan, done.stderr.strip().splitlines()[-1:]
    return *turned(out, nodes, ids), ""


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    with open(HERE / "reference.csv", encoding="utf-8") as file:
        reference = {(r["unit"], r["direction"]): r
                     for r in csv.DictReader(line for line in file if not line.startswith("#"))}
    print("unit,direction,moment_Nm,ours_deg,measured_deg,low,high,within,source")
    for unit in sys.argv[3:] or ["L3_L4", "T6_T7", "C4_C5"]:
        for direction in DIRECTIONS:
            time, angle, trouble = run(program, folder, unit, direction)
            row = reference.get((unit, direction), {})
            low, high = row.get("low", ""), row.get("high", "")
            within = ("yes" if float(low) <= angle <= float(high) else "no") if low else ""
            note = row.get("source", "") + (f"; ended at {time:.1f} ms {trouble}" if time < END - 1 else "")
            print(f"{unit},{direction},{MOMENT[unit[0]]:g},{angle:.2f},{row.get('rotation_deg', '')},{low},{high},{within},"
                  f"\"{note}\"", flush=True)


if __name__ == "__main__":
    main()
