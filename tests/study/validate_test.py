#!/usr/bin/env python3
"""Cases as a user runs them: a run is repeated when its content has changed and only then; runs side by side; the
resolution of a generated body; the table of ratings.

usage: validate_test.py FABRICA
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

FABRICA = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 else "build/fabrica"
ROOT = pathlib.Path(__file__).resolve().parents[2]
BAR = ROOT / "cases" / "verification" / "taylor-bar"
CASE = """title = "bar"
requirement = "the bar keeps its energy"
source = "made here"
deck = "taylor-bar.k"
end_time = {end}
[[check]]
name = "energy ratio"
model = "glstat:energy_ratio"
expected = 1.0
tolerance = 0.05
"""
BODY = """title = "femur"
requirement = "none"
source = "made here"
body = { bones = "femur" }
loads = "loads.k"
end_time = 0.0001
[[check]]
name = "time"
model = "glstat:time"
expected = 0.0
tolerance = 1
"""


class Validate(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def bar(self, name="bar", end="0.001"):
        case = self.folder / "cases" / name
        case.mkdir(parents=True, exist_ok=True)
        for file in ("mesh.k", "taylor-bar.k"):
            shutil.copy(BAR / file, case)
        (case / "case.toml").write_text(CASE.format(end=end))
        return case

    def validate(self, *options, status=0):
        done = subprocess.run([FABRICA, "validate", "--cases", self.folder / "cases", "--out", self.folder / "out",
                               *options], capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout

    def record(self, name):
        return json.loads((self.folder / "out" / name / "run.json").read_text())

    def test_a_run_is_repeated_when_its_content_changes_and_only_then(self):
        case = self.bar()
        self.assertIn("bar: runs", self.validate())
        self.assertNotIn("bar: runs", self.validate())
        for file in case.iterdir():
            file.touch()
        self.assertNotIn("bar: runs", self.validate(), "the time of a file is not its content")
        # what is only compared: no run, but another judgement
        text = (case / "case.toml").read_text()
        (case / "case.toml").write_text(text.replace("expected = 1.0", "expected = 3.0"))
        self.assertNotIn("bar: runs", self.validate(status=1))
        (case / "case.toml").write_text(text)
        # a file that the deck includes
        mesh = case / "mesh.k"
        mesh.write_text(mesh.read_text().replace("*END", "$ a comment\n*END") + "$ and one more\n")
        self.assertIn("bar: runs", self.validate())
        self.bar(end="0.002")
        self.assertIn("bar: runs", self.validate())
        # a result of another engine
        run = self.folder / "out" / "bar" / "run.json"
        run.write_text(json.dumps(self.record("bar") | {"fingerprint": "0" * 64}))
        self.assertIn("is not up to date", self.validate("--compare-only", status=1))
        self.assertIn("bar: runs", self.validate())

    def test_runs_side_by_side_and_threads(self):
        for i in range(3):
            self.bar(f"bar{i}")
        self.validate("--jobs", "3", "--threads", "1")
        results = [json.loads((self.folder / "out" / f"bar{i}" / "result" / "summary.json").read_text())
                   for i in range(3)]
        self.assertEqual({r["threads"] for r in results}, {1})
        self.assertEqual(len({r["hash"] for r in results}), 1)

    def test_resolution_of_a_generated_body(self):
        case = self.folder / "cases" / "femur"
        case.mkdir(parents=True)
        (case / "case.toml").write_text(BODY)
        (case / "loads.k").write_text("*KEYWORD\n*DATABASE_GLSTAT\n0.0001\n*END\n")
        elements = {}
        for resolution in ("coarse", "standard"):
            self.assertIn("femur: runs", self.validate("--resolution", resolution))
            summary = json.loads((self.folder / "out" / "femur" / "result" / "summary.json").read_text())
            elements[resolution] = summary["elements"]
            outcome = json.loads((self.folder / "out" / "femur" / "outcome.json").read_text())
            self.assertEqual(outcome["resolution"], resolution)
            self.assertNotIn("femur: runs", self.validate("--resolution", resolution))
        self.assertGreater(elements["standard"], 1.5 * elements["coarse"])

    def test_the_table_names_every_published_rating(self):
        case = self.folder / "cases" / "sled"
        case.mkdir(parents=True)
        (case / "curves.csv").write_text("# provenance: synthetic\ntime [ms],a [g]\n0,0\n1,2\n2,1\n3,0\n")
        (case / "case.toml").write_text(
            'title = "sled"\nrequirement = "none"\nsource = "made here"\n[[signal]]\nname = "head"\nunit = "g"\n'
            'model = "curves.csv:a"\nreference = "curves.csv:a [g]"\nrating = ["cora"]\n'
            'paper = "Frontal sled (Vezin 2001)/Head CG acceleration"\n')
        self.validate()
        lines = [line for line in self.validate("--table").splitlines()[1:]]
        self.assertRegex(lines[0], r"^sled +head +cora +1\.000 +Excellent +0\.612$")
        self.assertEqual(len(lines), 30)  # this one, and the 29 rows of the table that have no case here
        self.assertTrue(all("no case yet" in line for line in lines[1:]))
        self.assertEqual(len({len(line) for line in lines}), 1, "columns are aligned")

    def test_the_rating_of_all_signals_is_their_mean_by_weight(self):
        case = self.folder / "cases" / "sled"
        case.mkdir(parents=True)
        (case / "curves.csv").write_text("# provenance: synthetic\ntime [ms],a [g],b [g]\n" +
                                         "".join(f"{t},{50 - abs(t - 50)},{40 - 0.7 * abs(t - 48)}\n" for t in range(101)))
        signal = ('[[signal]]\nname = "{0}"\nunit = "g"\nmodel = "curves.csv:{0}"\nreference = "curves.csv:a [g]"\n'
                  'rating = ["cora", "iso18571"]\nweight = {1}\n')
        (case / "case.toml").write_text('title = "sled"\nrequirement = "none"\nsource = "made here"\n' +
                                        signal.format("a", 1) + signal.format("b", 3) +
                                        '[[limit]]\nname = "all"\nmodel = "rating:all:cora"\nleast = 0.5\n')
        self.assertIn("ok    all: ", self.validate())
        outcome = json.loads((self.folder / "out" / "sled" / "outcome.json").read_text())
        a, b = (s["ratings"]["cora"]["total"] for s in outcome["signals"])
        self.assertEqual(a, 1)
        self.assertLess(b, 0.99)
        self.assertAlmostEqual(outcome["cora_of_all"], (a + 3 * b) / 4, places=12)
        table = self.validate("--table")
        self.assertRegex(table, rf"sled +all signals +cora +{outcome['cora_of_all']:.3f} ")
        self.assertEqual(table.count("all signals"), 1)
        self.assertIn(f"{outcome['cora_of_all']:.3f}", (self.folder / "out" / "index.html").read_text())
        # a signal alone is its own total; weights below zero are refused
        (case / "case.toml").write_text('title = "sled"\nrequirement = "none"\nsource = "made here"\n' +
                                        signal.format("a", -1))
        self.assertIn("weight", self.validate(status=1))


if __name__ == "__main__":
    unittest.main()
