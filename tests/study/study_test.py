#!/usr/bin/env python3
"""A parameter study as a user meets it: killed in the middle (kill -9) it goes on without repeating a finished run; its
table holds every row; faults of a plan are named; the job array for a cluster is a sound script.

usage: study_test.py FABRICA
"""
import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

FABRICA = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 else "build/fabrica"
BAR = pathlib.Path(__file__).resolve().parents[2] / "cases" / "verification" / "taylor-bar"

PLAN = """
title = "speed and yield stress of a bar"
deck = "bar.k"
end_time = 0.02
[parameters]
speed = { range = [100, 300] }
ystress = { values = [0.3, 0.5] }
[sampling]
method = "latin_hypercube"
samples = 5
seed = 3
[[output]]
name = "kinetic energy at the start"
model = "glstat:kinetic_energy"
statistic = "max"
"""


class Study(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        shutil.copy(BAR / "mesh.k", self.folder)
        deck = (BAR / "taylor-bar.k").read_text().replace("    -227.0", "   -&speed").replace("       0.4       0.1",
                                                                                              "  &ystress       0.1")
        self.assertIn("&speed", deck)
        self.assertIn("&ystress", deck)
        (self.folder / "bar.k").write_text(deck)
        self.write_plan(PLAN)

    def tearDown(self):
        self.temporary.cleanup()

    def write_plan(self, text):
        (self.folder / "plan.toml").write_text(text)

    def command(self, *options):
        return [FABRICA, "study", str(self.folder / "plan.toml"), "--out", str(self.folder / "out"), *options]

    def study(self, *options):
        return subprocess.run(self.command(*options), capture_output=True, text=True)

    def finished(self):
        """What tells a run from a repeated one: file number and time of its record and of its result."""
        found = {}
        for record in (self.folder / "out" / "runs").glob("*/run.json"):
            stats = [p.stat() for p in (record, record.parent / "result" / "summary.json")]
            found[record.parent.name] = [(s.st_ino, s.st_mtime_ns) for s in stats]
        return found

    def test_a_killed_study_goes_on_without_repeating_a_finished_run(self):
        process = subprocess.Popen(self.command(), stdout=subprocess.DEVNULL)
        runs = self.folder / "out" / "runs"
        deadline = time.monotonic() + 120
        while not (len(self.finished() if runs.exists() else {}) >= 2) and time.monotonic() < deadline:
            time.sleep(0.01)
        process.kill()
        process.wait()
        before = self.finished()
        self.assertGreaterEqual(len(before), 2)
        self.assertLess(len(before), 5, "the study was over before it was killed")
        again = self.study()
        self.assertEqual(again.returncode, 0, again.stdout + again.stderr)
        self.assertIn(f"{len(before)} finished before, {5 - len(before)} to run", again.stdout)
        after = self.finished()
        self.assertEqual(len(after), 5)
        for name, marks in before.items():
            self.assertEqual(after[name], marks, f"row {name} was run again")
        # a quarter bar: its mass is that of the mesh, so that kinetic energy over speed squared is one number
        with open(self.folder / "out" / "study.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 5)
        masses = [2 * float(r["kinetic energy at the start"]) / float(r["speed"]) ** 2 for r in rows]
        for mass in masses:
            self.assertAlmostEqual(mass / masses[0], 1, delta=1e-5)
        self.assertEqual(len({r["speed"] for r in rows}), 5)
        self.assertIn("chart1", (self.folder / "out" / "index.html").read_text())

    def test_faults_of_a_plan_are_named(self):
        for old, new, words in [
            ("[parameters]", "[parameters]\ncolour = 1", ["colour", "no parameter that the deck refers to", "speed, ystress"]),
            ("ystress =", "ystres =", ["bar.k:", "parameter ystress is not defined"]),
            ('"latin_hypercube"', '"random"', ["sampling.method", "'random' is not known"]),
            ("samples = 5", "samples = 0", ["sampling.samples", "Give 1 to"]),
            ("samples = 5", "points = 5", ["samples"]),
            ("range = [100, 300]", "range = [300, 100]", ["speed.range", "not an interval"]),
            ('deck = "bar.k"', 'deck = "tube.k"', ["plan.toml:3", "there is no", "tube.k"]),
            ("end_time = 0.02", 'end_time = "soon"', ["plan.toml:4", "end_time", "not a number"]),
        ]:
            self.write_plan(PLAN.replace(old, new))
            done = self.study()
            self.assertEqual(done.returncode, 1, new)
            for word in words:
                self.assertIn(word, done.stderr)

    def test_a_job_array_runs_one_row_each(self):
        done = self.study("--slurm", "--jobs", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        script = self.folder / "out" / "job.sh"
        self.assertIn("#SBATCH --array=1-5%2", script.read_text())
        task = subprocess.run(["bash", str(script)], env={"SLURM_ARRAY_TASK_ID": "4", "PATH": "/usr/bin:/bin"},
                              capture_output=True, text=True)
        self.assertEqual(task.returncode, 0, task.stderr)
        self.assertEqual(list(self.finished()), ["00004"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
