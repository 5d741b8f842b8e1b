#!/usr/bin/env python3
"""Pulls joints of the skeleton with 50 N in six directions: does each keep together?

joint_pulls.py FABRICA OUT [JOINT ...] [--force 50]

Each joint is made of its bones alone (`fabrica body --trial` with a rig of joined bones): the first bone is held, the second
pulled at its frame's origin along x, y, z of the first bone's frame, both ways, its rotations held; the force rises in 10 ms and
stays for 10. Light damping (0.2 / ms). `fabrica joints` measures how far the surfaces come apart. Prints a table; exit status 1
if a joint comes apart by more than 3 mm or a run does not reach its end.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import joint_rig  # noqa: E402

# name: held, pulled, others that belong to the joint
JOINTS = {
    "atlantooccipital": ("C1", "skull", []),
    "atlantoaxial": ("C2", "C1", []),
    "C2-C3": ("C3", "C2", []),
    "C4-C5": ("C5", "C4", []),
    "C6-C7": ("C7", "C6", []),
    "T1-T2": ("T2", "T1", []),
    "T6-T7": ("T7", "T6", []),
    "T10-T11": ("T11", "T10", []),
    "T12-L1": ("L1", "T12", []),
    "L1-L2": ("L2", "L1", []),
    "L3-L4": ("L4", "L3", []),
    "L5-sacrum": ("sacrum", "L5", []),
    "costovertebral_6": ("T6", "right.rib6", ["T5"]),
    "costovertebral_1": ("T1", "right.rib1", []),
    "costovertebral_11": ("T11", "right.rib11", []),
    "costochondral_6": ("right.rib6", "right.costal_cartilage6", []),
    "temporomandibular": ("skull", "mandible", []),
    "sternoclavicular": ("manubrium", "right.clavicle", []),
    "acromioclavicular": ("right.scapula", "right.clavicle", []),
    "glenohumeral": ("right.scapula", "right.humerus", []),
    "elbow": ("right.humerus", "right.ulna", ["right.radius"]),
    "radioulnar": ("right.ulna", "right.radius", []),
    "wrist": ("right.radius", "right.lunate", ["right.scaphoid", "right.ulna"]),
    "carpometacarpal_1": ("right.trapezium", "right.metacarpal1", []),
    "carpometacarpal_3": ("right.capitate", "right.metacarpal3", []),
    "metacarpophalangeal_3": ("right.metacarpal3", "right.hand_phalanx3_proximal", []),
    "interphalangeal_3": ("right.hand_phalanx3_proximal", "right.hand_phalanx3_middle", []),
    "sacroiliac": ("sacrum", "right.hip_bone", []),
    "pubic_symphysis": ("left.hip_bone", "right.hip_bone", []),
    "hip": ("right.hip_bone", "right.femur", []),
    "knee": ("right.femur", "right.tibia", ["right.fibula"]),
    "tibiofibular": ("right.tibia", "right.fibula", []),
    "ankle": ("right.tibia", "right.talus", ["right.fibula"]),
    "subtalar": ("right.talus", "right.calcaneus", []),
    "talus_navicular": ("right.talus", "right.navicular", []),
    "calcaneus_cuboid": ("right.calcaneus", "right.cuboid", []),
    "tarsometatarsal_1": ("right.cuneiform_med", "right.metatarsal1", []),
    "metatarsophalangeal_1": ("right.metatarsal1", "right.foot_phalanx1_proximal", []),
    "metatarsophalangeal_3": ("right.metatarsal3", "right.foot_phalanx3_proximal", []),
    "interphalangeal_toe_1": ("right.foot_phalanx1_proximal", "right.foot_phalanx1_distal", []),
}
# bones of hand and foot are rigid at coarse and cannot be potted
AT_STANDARD = {"wrist", "carpometacarpal_1", "carpometacarpal_3", "metacarpophalangeal_3", "interphalangeal_3",
               "tarsometatarsal_1", "metatarsophalangeal_1", "metatarsophalangeal_3", "interphalangeal_toe_1"}


def pull(fabrica, folder, name, joint, axis, sign, force):
    """How far the joint came apart and the bone moved in the direction of the pull [mm], and why the run ended early."""
    timing = "end_time     = 20\noutput_every = 0.2\nstates_every = 1\ndamping      = 0.2"
    free = ", ".join(f'"{d}"' for d in "xyz" if d != axis)
    kilonewtons = sign * force / 1000
    support = (f'free   = [{free}]\n'
               f'load   = [{{ along = "{axis}", force = [[0, 0], [10, {kilonewtons}], [20, {kilonewtons}]] }}]')
    stem = folder / f"{name}_{'+' if sign > 0 else '-'}{axis}"
    held, pulled, others = joint
    apart, failed = joint_rig.run(fabrica, stem, joint_rig.rig(timing, [held], [pulled], others, "pulled", support),
                                  "standard" if name in AT_STANDARD else "coarse")
    if failed:
        return None, None, failed
    last = joint_rig.histories(stem / "csv" / "rbdout.csv")[-1]
    return apart, abs(float(last[f"global_d{axis}:8000002"])), ""


def main():
    parser, read = joint_rig.arguments(__doc__, JOINTS)
    parser.add_argument("--force", type=float, default=50, help="N")
    a = read()
    bad = 0
    print("| joint | apart, the widest of six [mm] | moved in the direction of the pull, -x +x -y +y -z +z [mm] | remark |")
    print("| --- | --- | --- | --- |")
    for name in a.joints:
        results = [pull(a.fabrica, a.out, name, JOINTS[name], axis, sign, a.force) for axis in "xyz" for sign in (-1, 1)]
        failed = [r[2] for r in results if r[2]]
        apart = max((r[0] for r in results if r[0] is not None), default=float("nan"))
        moves = " ".join("-" if r[1] is None else f"{r[1]:.1f}" for r in results)
        bad += bool(failed) or not apart <= 3
        print(f"| {name} | {apart:.2f} | {moves} | {'; '.join(failed)} |", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
