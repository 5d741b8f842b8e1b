#!/usr/bin/env python3
"""Turns joints of the skeleton through their ranges and prints torque over angle.

joint_ranges.py FABRICA OUT [JOINT ...]

Each joint is made of its bones alone in a test rig: the first bone is held, the second turned about the centre of the joint
(data/anatomy/joint_tree.csv) at a steady rate after a start of 5 ms, while it may shift freely. The mass of the bone stands at that
centre: swung about it, it would load the joint. Ranges are those of data/anatomy/joint_axes.csv, axes rounded to those of the held
bone's frame. Torque on the turned bone, from the work W of the motion and the kinetic energy T:

    M = d(W - T) / d(angle)

as means over fifths of the range, against the motion where positive; a positive angle of flexion turns about +y (knee and elbow about
-y, so that they bend). Exit status 1 if a run does not reach its end or a joint comes apart by more than 3 mm.
"""
import csv
import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "cases/validation"))
import joint_rig  # noqa: E402

# joint: held, turned, others, axis, sign, joint and coordinate of the table
JOINTS = {
    "C4 flexion": ("C5", "C4", [], "ry", 1, "C4", "flexion"),
    "T6 flexion": ("T7", "T6", [], "ry", 1, "T6", "flexion"),
    "L3 flexion": ("L4", "L3", [], "ry", 1, "L3", "flexion"),
    "L3 lateral": ("L4", "L3", [], "rx", 1, "L3", "lateral"),
    "hip flexion": ("right.hip_bone", "right.femur", [], "ry", -1, "hip", "flexion"),
    "knee flexion": ("right.femur", "right.tibia", ["right.fibula", "right.patella"], "ry", 1, "knee", "flexion"),
    "knee flexion without fibula": ("right.femur", "right.tibia", ["right.patella"], "ry", 1, "knee", "flexion"),
    "ankle dorsiflexion": ("right.tibia", "right.talus", ["right.fibula", "right.calcaneus"], "ry", -1, "ankle", "dorsiflexion"),
    "shoulder flexion": ("right.scapula", "right.humerus", [], "ry", -1, "shoulder", "flexion"),
    "elbow flexion": ("right.humerus", "right.ulna", ["right.radius"], "ry", -1, "elbow", "flexion"),
}
RATE = 2  # degrees / ms
START = 5  # ms; twice that and half the rate where other bones are carried along


def row_of(table, **keys):
    lines = [line for line in (ROOT / "data/anatomy" / table).read_text().splitlines() if not line.startswith("#")]
    for row in csv.DictReader(lines):
        if all(row[key] == value for key, value in keys.items()):
            return row
    raise SystemExit(f"data/anatomy/{table} has no {keys}")


def limits(joint, coordinate):
    row = row_of("joint_axes.csv", joint=joint, coordinate=coordinate)
    return float(row["low"]), float(row["high"])


def centre(joint):
    """Of a joint in the frame of the bone that it turns [mm]."""
    row = row_of("joint_tree.csv", joint=joint)
    frame = row_of("assembly.csv", frame={"talus": "foot"}.get(row["child"], row["child"]), posture="stand")
    from_origin = [float(row[x]) - float(frame["t" + x]) for x in "xyz"]
    return [round(sum(float(frame[f"r{i + 1}{j}"]) * from_origin[i] for i in range(3)), 2) for j in (1, 2, 3)]


def torques(folder, radians, time, start):
    rows = joint_rig.histories(folder / "csv/glstat.csv")
    rate = abs(radians) / (time - start / 2)
    work = [float(r["external_work"]) - float(r["kinetic_energy"]) for r in rows]

    def angle(t):
        return rate * t * t / (2 * start) if t < start else rate * (t - start / 2)

    angles = [angle(float(r["time"])) for r in rows]
    out = []
    for k in range(5):
        low, high = abs(radians) * k / 5, abs(radians) * (k + 1) / 5
        i = min(range(len(angles)), key=lambda n: abs(angles[n] - low))
        j = min(range(len(angles)), key=lambda n: abs(angles[n] - high))
        out.append((work[j] - work[i]) / (angles[j] - angles[i]))  # kN mm = N m
    return out


def turn(fabrica, folder, name, joint, degrees):
    """Torques [N m] over fifths of the way, how far the joint came apart [mm], and why the run ended early."""
    held, turned, others, axis, sign = joint[:5]
    radians = sign * math.radians(degrees)
    slower = 2 if others else 1
    start = START * slower
    time = max(abs(degrees) / RATE * slower + start / 2 + 2, start + 0.5)
    rate = radians / (time - start / 2)
    timing = f"end_time     = {time:.2f}\noutput_every = {time / 200:.4f}\nstates_every = {time / 20:.4f}"
    support = ('free   = ["x", "y", "z"]\n'
               f'motion = {{ along = "{axis}", velocity = [[0, 0], [{start}, {rate:.6f}], [{time:.2f}, {rate:.6f}]] }}')
    stem = folder / f"{name.replace(' ', '_')}_{degrees:+g}"
    apart, failed = joint_rig.run(fabrica, stem, joint_rig.rig(timing, held, turned, others, "turned", support, centre(joint[5])))
    return (None if failed else torques(stem, radians, time, start)), apart, failed


def main():
    a = joint_rig.arguments(__doc__, JOINTS)[1]()
    bad = 0
    print("| joint | to [degrees] | torque over fifths of the way [N m] | apart [mm] | remark |")
    print("| --- | --- | --- | --- | --- |")
    for name in a.joints:
        for degrees in limits(*JOINTS[name][5:]):
            if degrees == 0:
                continue
            torque, apart, failed = turn(a.fabrica, a.out, name, JOINTS[name], degrees)
            bad += bool(failed) or not apart <= 3
            curve = "-" if torque is None else " ".join(f"{t:.2f}" for t in torque)
            print(f"| {name} | {degrees:g} | {curve} | {'-' if apart is None else f'{apart:.2f}'} | {failed} |", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
