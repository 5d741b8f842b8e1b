#!/usr/bin/env python3
"""Checks what no compiler checks. Run by ctest as `layers`; prints each breach as file:line and exits 1.

1. The folders of src/ form a strict order: a file may include only its own layer and the layers listed below.
2. No file names a folder of somebody's machine.
3. Every header starts with #pragma once; no source file has 500 lines or more, tests apart.
"""
import pathlib
import re
import subprocess
import sys

KERNELS = ["material", "element", "contact", "constraint", "load", "control"]
ALLOWED = {
    "base": [],
    **{kernel: ["base"] for kernel in KERNELS},
    "signal": ["base"],
    "injury": ["signal", "base"],
    "model": [*KERNELS, "base"],
    "solver": ["model", *KERNELS, "base"],
    "deck": ["model", "base"],
    "result": ["model", "base"],
    "body": ["model", "base"],
}
ALLOWED["study"] = ["deck", "result", "body", "solver", "signal", "injury", "model", "base"]
ALLOWED["app"] = ["study", *ALLOWED["study"], *KERNELS]
# the contract between elements and laws, and the adaptors to plane stress and uniaxial stress: not laws themselves
CONTRACT = {"material/point.h", "material/plane_stress.h", "material/uniaxial.h"}
# drivers that must not see each other
APART = [("solver/cpu", "solver/cuda")]

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
# written in pieces, so that this file does not breach its own rule
MACHINE = re.compile(r"(?<![\w./])/(" + "|".join(["wor" + "k", "tm" + "p", "hom" + "e", "roo" + "t", "User" + "s"]) + r")/")
TEXT = {".h", ".cpp", ".cu", ".cuh", ".md", ".txt", ".json", ".py", ".kw", ".k", ".toml", ".cmake", ".sh", ".csv", ""}
MOST_LINES = 500
LONG = {"src/model/model.h"}  # one list of plain definitions


def tracked(root):
    """Files of the working tree that git knows or would add."""
    out = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=root, capture_output=True, text=True)
    if out.returncode == 0:
        return [root / line for line in out.stdout.splitlines()]
    return [p for p in root.rglob("*") if p.is_file() and not any(s.startswith((".git", "build")) for s in p.parts)]


def layer_breaches(path, inside, lines):
    layer = inside.parts[0]
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match or "/" not in match[1]:
            continue
        target = pathlib.PurePosixPath(match[1])
        other = target.parts[0]
        if inside.stem.endswith("_test") and layer in KERNELS and other in KERNELS:
            continue  # a test of one kernel may drive it with another
        if other in ALLOWED and str(target) not in CONTRACT and other != layer and other not in ALLOWED[layer]:
            yield f"{path}:{number}: {layer} may not include {other}"
        for a, b in APART:
            for here, there in ((a, b), (b, a)):
                if str(inside).startswith(here + "/") and str(target).startswith(there + "/"):
                    yield f"{path}:{number}: {here} may not include {there}"


def breaches(root):
    for path in tracked(root):
        if path.suffix not in TEXT or not path.is_file() or path.name == "LICENSE":
            continue
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
        shown = path.relative_to(root)
        for number, line in enumerate(lines, 1):
            if MACHINE.search(line):
                yield f"{shown}:{number}: names a folder of a machine"
        if shown.parts[0] != "src" or path.suffix not in {".h", ".cpp", ".cu"}:
            continue
        inside = pathlib.PurePosixPath(*shown.parts[1:])
        if len(inside.parts) < 2:
            continue
        if inside.parts[0] not in ALLOWED:
            yield f"{shown}:1: folder src/{inside.parts[0]} has no place in the order"
            continue
        yield from layer_breaches(shown, inside, lines)
        if path.suffix == ".h" and (not lines or lines[0].strip() != "#pragma once"):
            yield f"{shown}:1: header does not start with #pragma once"
        if len(lines) >= MOST_LINES and not path.stem.endswith("_test") and str(shown) not in LONG:
            yield f"{shown}:{len(lines)}: {len(lines)} lines; files stay below {MOST_LINES}"


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    found = list(breaches(root))
    print("\n".join(found) if found else "the order of the folders holds")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
