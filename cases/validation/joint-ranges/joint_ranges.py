#!/usr/bin/env python3
"""Turns joints of the skeleton through their ranges and prints torque over angle.

joint_ranges.py FABRICA OUT [JOINT ...]

Joints are the rows of data/anatomy/joint_axes.csv, named as in "L3 flexion"; JOINT is a regular expression of whole names. Each is
made of its bones alone in a test rig: bones are held, others turned about the centre of the joint (data/anatomy/joint_tree.csv) and
about its axis, along which the rig is laid, at a steady rate after a start of 5 ms; the turned may shift freely. The mass of a bone
stands at that centre: swung about it, it would load the joint. Torque on the turned bones, from the work W of the motion and the
kinetic energy T:

    M = d(W - T) / d(angle)

as means over fifths of the range, against the motion where positive. Shift: the farthest that the joint's centre went in the turned
bone; it shows a head that leaves its socket while the surfaces stay in touch. Exit status 1 if a run does not reach its end or a
joint comes apart by more than 3 mm.
"""
import csv
import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "cases/validation"))
import joint_rig  # noqa: E402

CARPALS = ["scaphoid", "lunate", "triquetrum", "pisiform", "trapezium", "trapezoid", "capitate", "hamate"]
# joint: held, turned, carried along, where they are not the parent and the child of joint_tree.csv
BONES = {
    "L5": (["sacrum"], ["L5"], []),
    "head": (["C1"], ["skull"], []),
    "hip": (["hip_bone"], ["femur"], []),
    "knee": (["femur"], ["tibia"], ["fibula", "patella"]),
    "ankle": (["tibia"], ["talus"], ["fibula", "calcaneus"]),
    "subtalar": (["talus", "tibia", "fibula"], ["calcaneus"], []),
    "clavicle": (["manubrium", "costal_cartilage1", "left.clavicle"], ["clavicle"], []),
    "elbow": (["humerus"], ["ulna"], ["radius"]),
    "forearm": (["ulna", "humerus"], ["radius"], []),
    "wrist": (["radius", "ulna"], CARPALS[4:], CARPALS[:4]),
    **{f"mcp{ray}": ([f"metacarpal{ray}"], [f"hand_phalanx{ray}_proximal"], []) for ray in range(1, 6)},
    "cmc1": (["trapezium"], ["metacarpal1"], []),
}
LEFT_OUT = {"pelvis": "turns the whole body", "patella": "is drawn by quadriceps and tendon, which are not made"}
MIDLINE = {"skull", "sacrum", "manubrium", *(f"{part}{n}" for part, last in (("C", 7), ("T", 12), ("L", 5)) for n in range(1, last + 1))}
# the frames of assembly.csv that carry them
CARRIERS = {"skull": "head", "sacrum": "pelvis", "hip_bone": "pelvis", "manubrium": "thorax", "talus": "foot", "calcaneus": "foot",
            **{bone: "hand" for bone in CARPALS}}
# bones of the hand are rigid at coarse and cannot be potted
AT_STANDARD = {"wrist", "cmc1", "ip1", *(f"{joint}{ray}" for joint in ("mcp", "pip", "dip") for ray in range(1, 6))}
RATE = 2  # degrees / ms
START = 5  # ms; twice that and half the rate where other bones are carried along


def rows_of(table):
    lines = [line for line in (ROOT / "data/anatomy" / table).read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


TREE = {row["joint"]: row for row in rows_of("joint_tree.csv")}
FRAMES = {row["frame"]: row for row in rows_of("assembly.csv") if row["posture"] == "stand"}
JOINTS = {f"{row['joint']} {row['coordinate']}": row for row in rows_of("joint_axes.csv") if row["joint"] not in LEFT_OUT}


def sided(bones):
    return [bone if bone in MIDLINE or bone.startswith("left.") else "right." + bone for bone in bones]


def bones_of(joint):
    return BONES.get(joint) or ([TREE[joint]["parent"]], [TREE[joint]["child"]], [])


def frame_of(bone):
    hand = bone.startswith("hand_phalanx") or bone.startswith("metacarpal")
    return FRAMES["hand" if hand else CARRIERS.get(bone, bone)]


def in_frame(frame, direction):
    return [sum(float(frame[f"r{i + 1}{j + 1}"]) * direction[i] for i in range(3)) for j in range(3)]


def at_frame(frame, point):
    return [round(x, 3) for x in in_frame(frame, [point[i] - float(frame["t" + x]) for i, x in enumerate("xyz")])]


def torques(folder, angle):
    """Means over fifths of the way, those that the run came to, and how far that was [degrees]."""
    rows = joint_rig.histories(folder / "csv/glstat.csv")
    work = [float(r["external_work"]) - float(r["kinetic_energy"]) for r in rows]
    angles = [angle(float(r["time"])) for r in rows]
    way = angle(math.inf)
    out = []
    for k in range(5):
        low, high = way * k / 5, way * (k + 1) / 5
        if angles[-1] < high - way / 50:
            break
        i = min(range(len(angles)), key=lambda n: abs(angles[n] - low))
        j = min(range(len(angles)), key=lambda n: abs(angles[n] - high))
        out.append((work[j] - work[i]) / (angles[j] - angles[i]))  # kN mm = N m
    return out, math.degrees(angles[-1])


def shift(folder, pot):
    """The farthest that the pivot of a pot went [mm]."""
    rows = joint_rig.histories(folder / "csv/rbdout.csv")
    return max(math.hypot(*(float(row[f"global_d{x}:{8000000 + pot}"]) for x in "xyz")) for row in rows)


def turn(fabrica, folder, name, degrees):
    """Torques [N m] over fifths of the way, how far the joint came apart and shifted [mm], and why the run ended early."""
    row = JOINTS[name]
    held, turned, others = bones_of(row["joint"])
    centre = [float(TREE[row["joint"]][x]) for x in "xyz"]
    axis = [float(row["a" + x]) for x in "xyz"]
    frame = frame_of(held[0])
    across = min(([1, 0, 0], [0, 1, 0], [0, 0, 1]), key=lambda d: abs(sum(a * b for a, b in zip(in_frame(frame, axis), d))))
    laid = at_frame(frame, [c - 100 * a for c, a in zip(centre, axis)]), across
    slower = 2 if others else 1
    start = START * slower
    time = max(abs(degrees) / RATE * slower + start / 2 + 2, start + 0.5)
    rate = math.radians(degrees) / (time - start / 2)
    timing = f"end_time     = {time:.2f}\noutput_every = {time / 200:.4f}\nstates_every = {time / 20:.4f}"
    support = ('free   = ["x", "y", "z"]\n'
               f'motion = {{ along = "rx", velocity = [[0, 0], [{start}, {rate:.6f}], [{time:.2f}, {rate:.6f}]] }}')

    def angle(t):
        t = min(t, time)
        return abs(rate) * (t * t / (2 * start) if t < start else t - start / 2)

    stem = folder / f"{name.replace(' ', '_')}_{degrees:+g}"
    text = joint_rig.rig(timing, sided(held), sided(turned), sided(others), "turned", support, at_frame(frame_of(turned[0]), centre), laid)
    apart, failed = joint_rig.run(fabrica, stem, text, "standard" if row["joint"] in AT_STANDARD else "coarse")
    if not (stem / "csv/glstat.csv").exists():
        return [], apart, None, failed
    curve, reached = torques(stem, angle)
    return curve, apart, shift(stem, len(held) + 1), f"{reached:.1f} degrees: {failed}" if failed else ""


def main():
    a = joint_rig.arguments(__doc__, JOINTS)[1]()
    bad = 0
    print("| joint | to [degrees] | torque over fifths of the way [N m] | apart [mm] | shift [mm] | remark |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name in a.joints:
        for degrees in (float(JOINTS[name][end]) for end in ("low", "high")):
            if degrees == 0:
                continue
            torque, apart, moved, failed = turn(a.fabrica, a.out, name, degrees)
            bad += bool(failed) or not apart <= 3
            lengths = " | ".join("-" if x is None else f"{x:.2f}" for x in (apart, moved))
            print(f"| {name} | {degrees:g} | {' '.join(f'{t:.2f}' for t in torque) or '-'} | {lengths} | {failed} |", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
