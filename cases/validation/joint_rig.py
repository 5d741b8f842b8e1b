"""Joints of the skeleton in test rigs: what the scripts of joint-pulls and joint-ranges share."""
import argparse
import csv
import pathlib
import subprocess


def rig(timing, held, moved, others, name, support, pivot=(0, 0, 0)):
    """A rig of joined bones: `held` potted whole and fixed, `moved` potted whole about a point of its frame with the lines of
    `support` (free, load, motion), `others` carried along. `timing`: the lines above the pots."""
    bones = ", ".join(f'"{b}"' for b in [moved, *others])
    return f"""{timing}
[[pot]]
name   = "held"
bones  = ["{held}"]
toward = [0, 0, 1]
depth  = 2000
[[pot]]
name   = "{name}"
bones  = ["{moved}"]
toward = [0, 0, 1]
depth  = 2000
pivot_at = {list(pivot)}
{support}
[[specimen]]
bone = "{held}"
with = [{bones}]
"""


def run(fabrica, stem, text, resolution="coarse"):
    """Makes the deck of a rig, runs it into the folder `stem` and measures its joints: how far the widest came apart [mm] and
    "", or None and why the run ended."""
    rig_file, deck, joints, table = (stem.with_name(stem.name + end) for end in (".toml", ".k", "_joints.csv", ".csv"))
    rig_file.write_text(text)
    subprocess.run([fabrica, "body", "--trial", rig_file, "--resolution", resolution, "--out", deck, "--quiet"],
                   check=True, capture_output=True, text=True)
    out = subprocess.run([fabrica, "run", deck, "--out", stem, "--threads", "1", "--quiet"], capture_output=True, text=True)
    if out.returncode != 0:
        ending = [line for line in out.stdout.splitlines() if line.startswith("ending")]
        return None, (ending or ["run failed"])[0]
    subprocess.run([fabrica, "joints", stem, "--joints", joints, "--csv", table], check=True, capture_output=True, text=True)
    return max(float(row["apart"]) for row in histories(table)), ""


def histories(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def arguments(doc, joints):
    """The parser of the command line, and a function that reads it and checks the names of joints."""
    p = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("fabrica")
    p.add_argument("out", type=pathlib.Path)
    p.add_argument("joints", nargs="*", help="of the list; default all")

    def read():
        a = p.parse_args()
        a.out.mkdir(parents=True, exist_ok=True)
        for name in a.joints:
            if name not in joints:
                p.error(f"joint {name} is unknown; there are {', '.join(joints)}")
        a.joints = a.joints or list(joints)
        return a

    return p, read
