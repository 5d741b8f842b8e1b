#!/usr/bin/env python3
"""Makes the thinned bone tables again from the full ones and compares: thinned.py FULL_TABLES. Exit 77 (skipped) where
the full tables or numpy are not at hand."""
import filecmp
import importlib.util
import pathlib
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]
full = pathlib.Path(sys.argv[1])
if not full.is_dir():
    print(f"{full} is not here: skipped")
    sys.exit(77)
if not importlib.util.find_spec("numpy"):
    print("numpy is not here: skipped")
    sys.exit(77)
shipped = root / "data" / "anatomy" / "bones"
with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.executable, root / "tools" / "thin_anatomy.py", full, folder], check=True)
    made = sorted(path.name for path in pathlib.Path(folder).iterdir())
    different = [name for name in made if not filecmp.cmp(pathlib.Path(folder) / name, shipped / name, shallow=False)]
print(f"{len(made)} tables made, {len(different)} differ", *different)
sys.exit(bool(different) or not made)
