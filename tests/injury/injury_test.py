#!/usr/bin/env python3
"""Injury measures of tissues from a run, as a user gets them. Every node of the run is moved, so that each brick and
shell is stretched by a known factor s along x and nothing else, and back before the end: the largest logarithmic strain
is ln s, Green's (s^2 - 1)/2.

usage: injury_test.py FABRICA
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

FABRICA = str(pathlib.Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 else "build/fabrica"

# title of the part, its elements as (length along x, stretch)
SOLIDS = {"head.brain.gray": [(1, 1.2)] * 3, "head.brain.white": [(0.1, 1.4)], "bone": [(1, 1.7)]}
SHELLS = {"thorax.left.rib01.cortical": [(1, 1.01), (1, 1.03)], "thorax.left.rib02.cortical": [(1, 1.012)]}


def deck():
    """Bricks of length x 1 x 1 and shells of length x 1, none of which shares a node with another."""
    lines = ["*KEYWORD", "*CONTROL_TERMINATION", "1.0", "*DATABASE_BINARY_D3PLOT", "0.1", "*DATABASE_GLSTAT", "0.1",
             "*MAT_ELASTIC", "1,1.0e-6,0.001,0.3", "*SECTION_SOLID", "1,1", "*SECTION_SHELL", "2,2", "1.0,1.0,1.0,1.0",
             "*DEFINE_CURVE", "1", "0.0,0.0", "0.4,1.0", "0.6,1.0", "1.0,0.0", "2.0,0.0"]
    node = element = part = 0
    for family, parts in (("SOLID", SOLIDS), ("SHELL", SHELLS)):
        for title, elements in parts.items():
            part += 1
            lines += ["*PART", title, f"{part},{1 if family == 'SOLID' else 2},1"]
            for length, stretch in elements:
                element += 1
                z = 3.0 * element
                square = [(0, 0), (length, 0), (length, 1), (0, 1)]
                corners = [(*c, z + up) for up in ((0, 1) if family == "SOLID" else (0,)) for c in square]
                ids = range(node + 1, node + 1 + len(corners))
                node += len(corners)
                lines += ["*NODE"] + [f"{i},{x},{y},{h}" for i, (x, y, h) in zip(ids, corners)]
                lines += [f"*ELEMENT_{family}", f"{element},{part}," + ",".join(map(str, ids))]
                for i, (x, _, _) in zip(ids, corners):
                    lines += ["*BOUNDARY_SPC_NODE", f"{i},0,{int(x == 0)},1,1"]
                    if x:
                        lines += ["*BOUNDARY_PRESCRIBED_MOTION_NODE", f"{i},1,2,1,{length * (stretch - 1):.12g}"]
    return "\n".join(lines + ["*END", ""])


class Injury(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        (cls.folder / "deck.k").write_text(deck())
        done = subprocess.run([FABRICA, "run", cls.folder / "deck.k", "--out", cls.folder / "run"],
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def injury(self, *options):
        out = self.folder / "injury.json"
        out.unlink(missing_ok=True)
        done = subprocess.run([FABRICA, "injury", self.folder / "run", "--json", out, *options], capture_output=True,
                              text=True)
        measures = {m["name"]: m for m in json.loads(out.read_text())["measures"]} if out.exists() else {}
        return done, measures

    def near(self, measure, expected):
        # positions and displacements are single precision: 2^-24 of 20 mm over 0.1 mm
        self.assertAlmostEqual(measure["value"], expected, delta=1e-4 * abs(expected) + 1e-9)

    def test_parts_are_found_by_their_titles(self):
        done, m = self.injury()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.near(m["MPS"], 100 * math.log(1.4))
        # 3 of 3.1 mm3, 96.8 %, are stretched by 1.2
        self.near(m["MPS95"], 100 * math.log(1.2))
        self.near(m["CSDM"], 0.1 / 3.1)
        # one of two ribs lies above 1.8 %
        self.assertEqual(m["fractured ribs, strain"]["value"], 1)
        self.assertIn("2 ribs", m["fractured ribs, risk"]["detail"])
        self.assertIn("brain.strain: head.brain.gray, head.brain.white, 4 solids", done.stderr)
        # what is not confirmed is said in both outputs
        self.assertEqual((m["MPS"]["confirmed"], m["MPS95"]["confirmed"]), (True, False))
        self.assertIn("95 % of the volume here", m["MPS95"]["not_confirmed"])
        self.assertIn("not confirmed: " + m["MPS95"]["not_confirmed"], done.stdout)
        risk = m["fractured ribs, risk"]["risks"][0]
        self.assertFalse(risk["confirmed"])
        self.assertIn("not confirmed: " + risk["not_confirmed"], done.stdout)
        # what is not there is said, with the way to it
        self.assertIn("--part liver=", m["liver strain"]["missing"])

    def test_other_parts_strain_and_threshold(self):
        _, m = self.injury("--part", "brain=1", "--part", "liver=bone", "--part", "ribs=4+5", "--strain", "green",
                           "--set", "csdm_strain=0.2", "--set", "rib_strain=0.031")
        self.near(m["MPS"], 100 * (1.2 ** 2 - 1) / 2)
        self.near(m["liver strain"], 100 * (1.7 ** 2 - 1) / 2)
        self.near(m["CSDM"], 1)  # 0.22 > 0.2
        self.assertEqual(m["fractured ribs, strain"]["value"], 0)  # one rib of two parts, 0.03045
        self.assertIn("1 ribs", m["fractured ribs, risk"]["detail"])

    def test_faults_are_named(self):
        for options, name in ((("--part", "brain=77"), "no-such-part"), (("--part", "brain=4"), "no-elements"),
                              (("--part", "spine=1"), "bad-setting"), (("--part", "brain="), "bad-setting")):
            done, _ = self.injury(*options)
            self.assertEqual(done.returncode, 1, options)
            self.assertIn(f"[{name}]", done.stderr)
        (self.folder / "bare" / "csv").mkdir(parents=True, exist_ok=True)
        done = subprocess.run([FABRICA, "injury", self.folder / "bare", "--part", "brain=1"], capture_output=True,
                              text=True)
        self.assertIn("*DATABASE_BINARY_D3PLOT", done.stderr)


if __name__ == "__main__":
    unittest.main()
