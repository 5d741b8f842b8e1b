#!/usr/bin/env python3
"""Pulls joints of the skeleton with 50 N in six directions: does each keep together?

joint_pulls.py FABRICA OUT [JOINT ...] [--force 50]

Each joint is made of its bones alone (`fabrica body --trial` with a rig of joined bones): the first bone is held, the second
pulled at its frame's origin along x, y, z of the first bone's frame, both ways, its rotations held; the force rises in 10 ms and
stays for 10. Light damping (0.2 / ms). `fabrica joints` measures how far the surfaces come apart. Prints a table; exit status 1
if a joint comes apart by more than 3 mm or a run does not reach its end.
"""
import argparse
import csv
import pathlib
import subprocess
import sys

# name: held, pulled, others that belong to the joint
JOINTS = {
    "atlantooccipital": ("C1", "skull", []),
    "atlantoaxial": ("C2", "C1", []),
    "C4-C5": ("C5", "C4", []),
    "T6-T7": ("T7", "T6", []),
    "L3-L4": ("L4", "L3", []),
    "L5-sacrum": ("sacrum", "L5", []),
    "costovertebral_6": ("T6", "right.rib6", ["T5"]),
    "costochondral_6": ("right.rib6", "right.costal_cartilage6", []),
    "temporomandibular": ("skull", "mandible", []),
    "sternoclavicular": ("manubrium", "right.clavicle", []),
    "acromioclavicular": ("right.scapula", "right.clavicle", []),
    "glenohumeral": ("right.scapula", "right.humerus", []),
    "elbow": ("right.humerus", "right.ulna", ["right.radius"]),
    "radioulnar": ("right.ulna", "right.radius", []),
    "sacroiliac": ("sacrum", "right.hip_bone", []),
    "pubic_symphysis": ("left.hip_bone", "right.hip_bone", []),
    "hip": ("right.hip_bone", "right.femur", []),
    "knee": ("right.femur", "right.tibia", ["right.fibula"]),
    "tibiofibular": ("right.tibia", "right.fibula", []),
    "ankle": ("right.tibia", "right.talus", ["right.fibula"]),
    "subtalar": ("right.talus", "right.calcaneus", []),
    "talus_navicular": ("right.talus", "right.navicular", []),
    "calcaneus_cuboid": ("right.calcaneus", "right.cuboid", []),
}


def rig(held, pulled, others, axis, sign, force):
    with_bones = ", ".join(f'"{b}"' for b in [pulled, *others])
    return f"""end_time     = 20
output_every = 0.2
states_every = 1
damping      = 0.2
[[pot]]
name   = "held"
bones  = ["{held}"]
toward = [0, 0, 1]
depth  = 2000
[[pot]]
name   = "pulled"
bones  = ["{pulled}"]
toward = [0, 0, 1]
depth  = 2000
pivot_at = [0, 0, 0]
free   = [{", ".join(f'"{d}"' for d in "xyz" if d != axis)}]
load   = [{{ along = "{axis}", force = [[0, 0], [10, {sign * force / 1000}], [20, {sign * force / 1000}]] }}]
[[specimen]]
bone = "{held}"
with = [{with_bones}]
"""


def run(fabrica, folder, name, joint, axis, sign, force):
    stem = folder / f"{name}_{'+' if sign > 0 else '-'}{axis}"
    stem.with_suffix(".toml").write_text(rig(*joint, axis, sign, force))
    deck = stem.with_suffix(".k")
    subprocess.run([fabrica, "body", "--trial", stem.with_suffix(".toml"), "--out", deck, "--quiet"],
                   check=True, capture_output=True, text=True)
    out = subprocess.run([fabrica, "run", deck, "--out", stem, "--threads", "1", "--quiet"], capture_output=True, text=True)
    if out.returncode != 0:
        ending = [line for line in out.stdout.splitlines() if line.startswith("ending")]
        return None, None, (ending or ["run failed"])[0]
    table = stem.with_suffix(".csv")
    subprocess.run([fabrica, "joints", stem, "--joints", folder / f"{deck.stem}_joints.csv", "--csv", table],
                   check=True, capture_output=True, text=True)
    rows = list(csv.DictReader(table.open()))
    moved = list(csv.DictReader((stem / "csv" / "rbdout.csv").open()))[-1]
    shift = abs(float(moved[f"global_d{axis}:8000002"]))
    return max(float(r["apart"]) for r in rows), shift, ""


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("fabrica")
    p.add_argument("out", type=pathlib.Path)
    p.add_argument("joints", nargs="*", help="of the list; default all")
    p.add_argument("--force", type=float, default=50, help="N")
    a = p.parse_args()
    a.out.mkdir(parents=True, exist_ok=True)
    for name in a.joints:
        if name not in JOINTS:
            p.error(f"joint {name} is unknown; there are {', '.join(JOINTS)}")
    bad = 0
    print("| joint | apart, the widest of six [mm] | moved in the direction of the pull, -x +x -y +y -z +z [mm] | remark |")
    print("| --- | --- | --- | --- |")
    for name in a.joints or JOINTS:
        results = [run(a.fabrica, a.out, name, JOINTS[name], axis, sign, a.force) for axis in "xyz" for sign in (-1, 1)]
        failed = [r[2] for r in results if r[2]]
        apart = max((r[0] for r in results if r[0] is not None), default=float("nan"))
        moves = " ".join("-" if r[1] is None else f"{r[1]:.1f}" for r in results)
        bad += bool(failed) or not apart <= 3
        print(f"| {name} | {apart:.2f} | {moves} | {'; '.join(failed)} |", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
