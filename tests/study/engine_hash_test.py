#!/usr/bin/env python3
"""A run is up to date only for what computed it: the hash of the engine changes with any source of its layers and any
table of data/, and with nothing else.

usage: engine_hash_test.py ROOT
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()


class EngineHash(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        shutil.copytree(ROOT / "src" / "load", self.folder / "src" / "load")
        shutil.copytree(ROOT / "data" / "paper", self.folder / "data" / "paper")
        (self.folder / "data" / "anatomy").mkdir()
        (self.folder / "data" / "anatomy" / "bone.csv").write_text("length\n1.0\n")
        self.first = self.hash()

    def tearDown(self):
        self.temporary.cleanup()

    def hash(self):
        out = self.folder / "hash.cpp"
        subprocess.run(["cmake", f"-DOUTPUT={out}", f"-DROOT={self.folder / 'src'}", "-DLAYERS=load",
                        f"-DDATA={self.folder / 'data'}", "-P", ROOT / "cmake" / "hash_sources.cmake"], check=True)
        return re.search('"([0-9a-f]{64})"', out.read_text()).group(1)

    def test_it_stays_where_nothing_changes(self):
        self.assertEqual(self.hash(), self.first)

    def test_a_table_counts_by_content_and_name(self):
        table = self.folder / "data" / "anatomy" / "bone.csv"
        table.touch()
        self.assertEqual(self.hash(), self.first)
        table.write_text("length\n1.1\n")
        changed = self.hash()
        self.assertNotEqual(changed, self.first)
        table.rename(table.with_name("rib.csv"))
        self.assertNotIn(self.hash(), (changed, self.first))

    def test_a_source_counts_and_its_test_does_not(self):
        source = next(p for p in sorted((self.folder / "src").rglob("*.h")) if not p.stem.endswith("_test"))
        (source.parent / "more_test.cpp").write_text("// not part of any run\n")
        self.assertEqual(self.hash(), self.first)
        source.write_text(source.read_text() + "\n// a change\n")
        self.assertNotEqual(self.hash(), self.first)


if __name__ == "__main__":
    unittest.main()
