"""Joints of the skeleton in test rigs: what the scripts of joint-pulls and joint-ranges share."""
import argparse
import csv
import pathlib
import re
import subprocess


def quoted(bones):
    return ", ".join(f'"{bone}"' for bone in bones)


def rig(timing, held, moved, others, name, support, pivot=(0, 0, 0), laid=None):
    """A rig of joined bones: `held` potted whole and fixed, `moved` potted whole about a point of their frame with the lines of
    `support` (free, load, motion), `others` carried along. `timing`: the lines above the pots. Its axes are those of the frame of
    the first held bone or, `laid` by a point and a direction of that frame, x runs from the point to the pivot, z by the direction."""
    start, along = "", ""
    if laid:
        start = f"pivot_at = {list(laid[0])}\n"
        along = f'along = ["held", "{name}"]\nup = {list(laid[1])}\n'
    return f"""{timing}
[[pot]]
name   = "held"
bones  = [{quoted(held)}]
toward = [0, 0, 1]
depth  = 2000
{start}[[pot]]
name   = "{name}"
bones  = [{quoted(moved)}]
toward = [0, 0, 1]
depth  = 2000
pivot_at = {list(pivot)}
{support}
[[specimen]]
bone = "{held[0]}"
with = [{quoted([*held[1:], *moved, *others])}]
{along}"""


def run(fabrica, stem, text, resolution="coarse"):
    """Makes the deck of a rig, runs it into the folder `stem` and measures its joints: how far the widest came apart [mm] or
    None, and why the run ended early or ""."""
    rig_file, deck, joints, table = (stem.with_name(stem.name + end) for end in (".toml", ".k", "_joints.csv", ".csv"))
    rig_file.write_text(text)

    def call(*arguments):
        return subprocess.run([fabrica, *arguments, "--quiet"], capture_output=True, text=True)

    made = call("body", "--trial", rig_file, "--resolution", resolution, "--out", deck)
    if made.returncode != 0:
        return None, " ".join(made.stderr.split()) or "rig not made"
    ran = call("run", deck, "--out", stem, "--threads", "1")
    measured = subprocess.run([fabrica, "joints", stem, "--joints", joints, "--csv", table], capture_output=True, text=True)
    apart = max(float(row["apart"]) for row in histories(table)) if measured.returncode == 0 else None
    if ran.returncode != 0:
        return apart, ([line for line in ran.stdout.splitlines() if line.startswith("ending")] or ["run failed"])[0]
    return apart, "" if apart is not None else "joints not measured"


def histories(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def arguments(doc, joints):
    """The parser of the command line, and a function that reads it and checks the names of joints."""
    p = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("fabrica")
    p.add_argument("out", type=pathlib.Path)
    p.add_argument("joints", nargs="*", help="regular expressions of whole names, as '(C.|head) flexion'; default all")

    def read():
        a = p.parse_args()
        a.out.mkdir(parents=True, exist_ok=True)
        for pattern in a.joints:
            if not any(re.fullmatch(pattern, name) for name in joints):
                p.error(f"no joint {pattern}; there are {', '.join(joints)}")
        a.joints = [name for name in joints if not a.joints or any(re.fullmatch(p, name) for p in a.joints)]
        return a

    return p, read
