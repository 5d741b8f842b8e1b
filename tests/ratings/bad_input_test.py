#!/usr/bin/env python3
"""Bad curves as a user meets them: each fault ends `fabrica rate`, `fabrica filter` or `fabrica validate` with status 1 and
one named error that says where and what to do, and no rating is printed. Corridors of known curves beside them.

usage: bad_input_test.py FABRICA
"""
import csv
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

FABRICA = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 else "build/fabrica"

CASE = """
title = "two curves"
requirement = "none"
source = "made here"
[[signal]]
name = "force"
model = "model.csv:force"
unit = "kN"
reference = "{reference}"
rating = ["cora"]
"""


class Files(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, name, head, rows, top=""):
        text = top + head + "\n" + "".join(",".join(map(str, row)) + "\n" for row in rows)
        (self.folder / name).write_text(text)
        return self.folder / name

    def pulse(self, name="a.csv", head="time [ms],force [kN]", step=0.5, end=100.0, height=2.0):
        times = [i * step for i in range(int(end / step) + 1)]
        return self.write(name, head, [(t, f"{height * math.sin(math.pi * t / end) ** 2:.9g}") for t in times])

    def fabrica(self, *arguments):
        return subprocess.run([FABRICA, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)

    def refused(self, done, name, *words):
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        for word in (f"[{name}]", *words):
            self.assertIn(word, done.stderr)
        self.assertNotIn("total", done.stdout)


class BadPairs(Files):
    def rate(self, reference, signal, *options):
        return self.fabrica("rate", "--reference", f"{reference}:force", "--signal", f"{signal}:force", *options)

    def test_a_good_pair_is_rated(self):
        done = self.rate(self.pulse(), self.pulse("b.csv"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"total\s+1\.000")

    def test_different_time_bases(self):
        self.refused(self.rate(self.pulse(), self.pulse("b.csv", step=1.0)), "different-time-base", "201 samples",
                     "101", "--resample")

    def test_steps_that_differ(self):
        rows = [(0, 0), (1, 1), (2, 2), (4, 1), (5, 0)]
        uneven = self.write("u.csv", "time [ms],force [kN]", rows)
        self.refused(self.rate(uneven, uneven), "not-uniform", "constant step", "--resample")

    def test_not_a_number(self):
        for text in ("nan", "inf", "abc", "1.2.3"):
            bad = self.write("b.csv", "time [ms],force [kN]", [(0, 0), (1, text), (2, 1)])
            self.refused(self.rate(bad, bad), "not-a-number", "b.csv:3", text)

    def test_time_that_goes_back(self):
        bad = self.write("b.csv", "time [ms],force [kN]", [(0, 0), (2, 1), (1, 2), (3, 1)])
        self.refused(self.rate(bad, bad), "time-not-ascending", "sample 3")

    def test_a_reference_without_units(self):
        self.refused(self.rate(self.pulse("bare.csv", "time [ms],force"), self.pulse()), "unit-missing", "force")
        self.refused(self.rate(self.pulse("bare.csv", "time,force [kN]"), self.pulse()), "unit-missing", "force")
        self.assertEqual(self.rate(self.folder / "bare.csv", self.pulse(), "--x-unit", "ms").returncode, 0)

    def test_units_of_another_kind(self):
        self.refused(self.rate(self.pulse(), self.pulse("m.csv", "time [ms],force [mm]")), "different-units")

    def test_an_empty_corridor(self):
        self.refused(self.rate(self.pulse(), self.pulse(), "--set", "b_0=0.05"), "empty-corridor", "b_0")

    def test_a_channel_and_a_file_that_are_not_there(self):
        self.pulse()
        self.refused(self.fabrica("rate", "--reference", "a.csv:torque", "--signal", "a.csv:force"), "no-such-channel",
                     "torque", "There are: time [ms], force [kN]")
        self.refused(self.rate("none.csv", "a.csv"), "no-such-file", "none.csv")

    def test_an_interval_outside(self):
        self.refused(self.rate(self.pulse(), self.pulse(), "--t-min", "0", "--t-max", "500"), "bad-interval")

    def test_a_row_with_a_cell_too_few(self):
        bad = self.write("b.csv", "time [ms],force [kN]", [(0, 0), (1,), (2, 1)])
        self.refused(self.rate(bad, bad), "ragged-signal", "b.csv:3")

    def test_a_reference_that_does_not_move(self):
        self.refused(self.rate(self.pulse(height=0.0), self.pulse("b.csv")), "flat-reference")

    def test_an_unknown_parameter(self):
        self.refused(self.rate(self.pulse(), self.pulse(), "--set", "a_1=3"), "unknown-parameter", "a_sigma")


class Corridors(Files):
    def columns(self, name):
        rows = list(csv.DictReader((self.folder / name).read_text().splitlines()))
        return {key: [float(row[key]) for row in rows] for key in rows[0]}

    def test_mean_and_standard_deviation(self):
        # heights 1, 2, 3: mean 2, standard deviation of the sample 1
        curves = [f"{self.pulse(f'{h}.csv', height=h)}:force" for h in (1, 2, 3)]
        done = self.fabrica("filter", *curves, "--corridor", "mean", "--out", "c.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        c = self.columns("c.csv")
        middle = c["time [ms]"].index(50)
        for column, value in (("mean [kN]", 2), ("low [kN]", 1), ("high [kN]", 3), ("sd [kN]", 1)):
            self.assertAlmostEqual(c[column][middle], value, places=6)

    def test_arc_length_of_loops_that_end_apart(self):
        # straight loops to (10, 4) and (20, 8) and back: half way round the mean is at (15, 6)
        for name, s in (("1.csv", 1), ("2.csv", 2)):
            self.write(name, "d [mm],force [kN]", [(0, 0), (10 * s, 4 * s), (0, 0)])
        done = self.fabrica("filter", "1.csv:force", "2.csv:force", "--corridor", "arc-length", "--out", "c.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        c = self.columns("c.csv")
        half = len(c["x [1]"]) // 2
        self.assertAlmostEqual(c["mean_x [mm]"][half], 15, delta=0.3)
        self.assertAlmostEqual(c["mean_y [kN]"][half], 6, delta=0.12)

    def test_what_makes_no_corridor(self):
        a = f"{self.pulse()}:force"
        late = self.write("late.csv", "time [ms],force [kN]", [(500, 0), (501, 1), (502, 0)])
        for curves, name in (((a,), "too-few-curves"), ((a, f"{late}:force"), "interval-not-covered")):
            self.refused(self.fabrica("filter", *curves, "--corridor", "mean", "--out", "c.csv"), name)
        self.refused(self.fabrica("filter", a, a, "--corridor", "arc-length", "--cfc", "60", "--out", "c.csv"),
                     "not-a-time-history")


class BadCases(Files):
    def validate(self, reference="reference.csv:force [kN]", head="time [ms],force [kN]", value="1",
                 top="# provenance: measured\n", edges="", more=""):
        self.write("model.csv", "time [ms],force [kN]", [(0, 0), (1, 2), (2, 1)])
        self.write("reference.csv", head, [(0, f"0{edges}"), (1, f"{value}{edges}"), (2, f"1{edges}")], top)
        (self.folder / "case.toml").write_text(CASE.format(reference=reference) + more)
        return self.fabrica("validate", "--cases", ".", "--out", "out")

    def wrong(self, done, *words):
        self.assertEqual(done.returncode, 1, done.stdout)
        for word in words:
            self.assertIn(word, done.stdout)
        self.assertNotIn("cora", done.stdout)

    def test_a_good_case_is_rated(self):
        done = self.validate()
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("force: cora", done.stdout)

    def test_a_reference_without_a_unit(self):
        self.wrong(self.validate("reference.csv:force", "time [ms],force"), "case.toml:5", "signal.reference",
                   "has no unit in its header", "force [kN]")

    def test_another_unit(self):
        self.wrong(self.validate("reference.csv:force [N]", "time [ms],force [N]"), "signal.unit", "'N'", "'kN'")

    def test_another_unit_of_time(self):
        self.wrong(self.validate(head="time [s],force [kN]"), "is given over s, the model over ms")

    def test_a_cell_that_is_no_number(self):
        self.wrong(self.validate(value="abc"), "reference.csv", "abc")

    def test_a_channel_that_is_not_there(self):
        self.wrong(self.validate("reference.csv:torque"), "torque", "force [kN]")

    def test_an_empty_corridor_and_one_upside_down(self):
        more = 'corridor = ["reference.csv:low [kN]", "reference.csv:high [kN]"]\n'
        head = "time [ms],force [kN],low [kN],high [kN]"
        self.wrong(self.validate(head=head, edges=",,", more=more), "case.toml:5", "signal.corridor", "is empty")
        self.wrong(self.validate(head=head, edges=",2,1", more=more), "case.toml:5", "signal.corridor",
                   "lies above the upper one at 0")
        self.assertEqual(self.validate(head=head, edges=",0,2", more=more).returncode, 0)

    def test_numbers_of_unknown_origin_are_shown_but_not_rated(self):
        done = self.validate(top="")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("not rated", done.stdout)
        self.assertNotIn("cora", done.stdout)


if __name__ == "__main__":
    unittest.main()
