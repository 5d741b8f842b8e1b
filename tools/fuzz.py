#!/usr/bin/env python3
"""Fuzzes the deck reader: `tools/fuzz.py --time 3600` after `cmake --preset fuzz && cmake --build --preset fuzz`.

The corpus starts from tests/decks_broken, the cases' small decks, and one small deck for every keyword of the
vocabulary, so that each schema is reached; the names and options of the keywords form the dictionary. What is found
lies in OUT/found. Prints the number of executions, their time and what was found; exit status 1 if anything was.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
MESH = """*NODE
       1              0.              0.              0.       0       0
       2              1.              0.              0.       0       0
       3              1.              1.              0.       0       0
       4              0.              1.              0.       0       0
*PART
part
         1         1         1         1
*DEFINE_CURVE
         1
                  0.                  0.
                  1.                  1.
*SET_NODE_LIST
         1
         1         2         3         4
"""


def keywords():
    """Names, aliases and options of every keyword, and its number of cards."""
    for path in sorted((ROOT / "src/deck/keywords").glob("*.kw")):
        entry = None
        for line in path.read_text().splitlines():
            words = line.split()
            if not words:
                continue
            if words[0] == "keyword":
                if entry:
                    yield entry
                entry = {"names": [words[1]], "options": [], "cards": 0}
            elif entry and words[0] == "alias":
                entry["names"] += words[1:]
            elif entry and words[0] == "options":
                entry["options"] += words[1:]
            elif entry and words[0] == "card":
                entry["cards"] += 1
        if entry:
            yield entry


def write_seeds(folder):
    """One deck a keyword, below a mesh that its ids can name; small decks of the repository as they are."""
    folder.mkdir(parents=True, exist_ok=True)
    for k in keywords():
        row = "".join(f"{1:10d}" for _ in range(8)) + "\n"
        deck = f"*KEYWORD\n{MESH}*{k['names'][0]}\n" + row * max(1, k["cards"]) + "*END\n"
        (folder / (k["names"][0].replace("/", "_") + ".k")).write_text(deck)
    for pattern in ("tests/decks_broken/*.k", "cases/**/*.k"):
        for path in ROOT.glob(pattern):
            if path.stat().st_size < 8192:
                (folder / path.name).write_bytes(path.read_bytes())


def write_dictionary(path):
    words = {"KEYWORD", "PARAMETER", "PARAMETER_EXPRESSION", "NODE", "ELEMENT_SOLID", "ELEMENT_SHELL", "TITLE", "END",
             "INCLUDE_TRANSFORM", "LONG=Y", "I10=Y", "TRANSL", "ROTATE", "SCALE", "MIRROR", "POINT", "PART", "BOX"}
    for k in keywords():
        words.update(k["names"])
        words.update("_" + o for o in k["options"])
    path.write_text("".join(f'"{w}"\n' for w in sorted(words)) + '"\\x0a*"\n"&a"\n"-&a"\n"         1"\n')


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--time", type=int, default=600, help="seconds in all")
    arguments.add_argument("--target", default=str(ROOT / "build-fuzz/src/reader_fuzz"))
    arguments.add_argument("--out", type=pathlib.Path, default=ROOT / "out/fuzz")
    a = arguments.parse_args()
    corpus, seeds, found = a.out / "corpus", a.out / "seeds", a.out / "found"
    for folder in (corpus, found):
        folder.mkdir(parents=True, exist_ok=True)
    write_seeds(seeds)
    write_dictionary(a.out / "keywords.dict")
    start, executions = time.time(), 0
    # a finding ends the process: go on with the corpus reached so far until the time is used
    while (left := a.time - int(time.time() - start)) > 0:
        log = subprocess.run(
            ["nice", "-n", "19", a.target, str(corpus), str(seeds), f"-dict={a.out / 'keywords.dict'}", "-max_len=8192",
             "-timeout=20", "-rss_limit_mb=2048", f"-max_total_time={left}", f"-artifact_prefix={found}/",
             "-print_final_stats=1"], stderr=subprocess.PIPE, text=True, errors="replace").stderr
        (a.out / "last.log").write_text(log)
        executions += sum(int(n) for n in re.findall(r"stat::number_of_executed_units:\s*(\d+)", log))
        print(f"{time.time() - start:.0f} s, {executions} executions, {len(list(found.iterdir()))} found", flush=True)
    return 1 if any(found.iterdir()) else 0


if __name__ == "__main__":
    sys.exit(main())
