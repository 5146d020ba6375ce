# SPDX-License-Identifier: Apache-2.0
"""The hash that names caches changes with every source that growth can use, and with nothing else."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from modules import read_modules

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROOMS = ["base", "image", "geom", "groom"]


class GrowthIdentity(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        for room in ROOMS + ["cache"]:
            shutil.copytree(ROOT / room, self.root / room)

    def tearDown(self):
        self.folder.cleanup()

    def identity(self, build="c++ -O2"):
        out = self.root / "out.cpp"
        subprocess.run(["cmake", "-D", f"OUT={out}", "-D", f"ROOT={self.root}", "-D", "ROOMS=" + ",".join(ROOMS),
                        "-D", f"BUILD={build}", "-P", ROOT / "cmake" / "HashSources.cmake"], check=True)
        return out.read_text()

    def test_every_source_counts(self):
        right = self.identity()
        self.assertEqual(self.identity(), right)
        self.assertNotEqual(self.identity("c++ -O3"), right)
        for name in ("base/hash.h", "image/noise.cpp", "geom/limit_surface.cpp", "geom/io/hair_file.cpp", "groom/operators/curl.cpp"):
            path = self.root / name
            before = path.read_bytes()
            path.write_bytes(before + b"// more\n")
            self.assertNotEqual(self.identity(), right, name)
            path.write_bytes(before)
        (self.root / "groom" / "new_operator.cpp").write_text("")
        self.assertNotEqual(self.identity(), right)
        (self.root / "groom" / "new_operator.cpp").unlink()
        (self.root / "cache" / "residency.cpp").write_text("")
        self.assertEqual(self.identity(), right)

    def test_growth_includes_no_other_module(self):
        listed = (ROOT / "groom" / "CMakeLists.txt").read_text()
        self.assertIn("set(rooms " + " ".join(ROOMS) + ")", listed)
        table = read_modules((ROOT / "docs" / "ARCHITECTURE.md").read_text())
        self.assertEqual(table["groom"].may_include | {"groom"}, set(ROOMS))


if __name__ == "__main__":
    unittest.main()
