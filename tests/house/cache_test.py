# SPDX-License-Identifier: Apache-2.0
"""cache_test.py PELAGE STRANDS: processes that share an operator cache, die over it or find it damaged grow the same hair."""
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

SCENE = pathlib.Path(__file__).resolve().parents[2] / "examples" / "tuft.yaml"
STRANDS = int(sys.argv.pop())  # enough for a process to be killed in the middle
PELAGE = sys.argv.pop()


class Cache(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.cache = self.path / "cache"

    def tearDown(self):
        self.folder.cleanup()

    def start(self, *more):
        return subprocess.Popen(
            [PELAGE, "grow", SCENE, "--threads", "2", "--set", f"grooms.coat.strands={STRANDS}",
             "--set", f"grooms.coat.leaf_strands={STRANDS // 12}",
             "--set", f"grooms.coat.cache={{directory: {self.cache}, freeze: frizz}}", *more],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def grow(self, *more):
        out, errors = (process := self.start("--quiet", *more)).communicate(timeout=100)
        self.assertEqual(process.returncode, 0, errors)
        return out, errors

    def strands(self):
        file = self.path / "strands.hair"
        out, errors = self.grow("-o", file)
        return file.read_bytes(), out, errors

    def test_two_at_once(self):
        right, _, _ = self.strands()
        for path in self.cache.iterdir():
            path.unlink()
        both = [self.start("--quiet"), self.start("--quiet")]
        outs = [process.communicate(timeout=100) for process in both]
        self.assertEqual([process.returncode for process in both], [0, 0])
        self.assertEqual([errors for _, errors in outs], ["", ""])
        self.assertEqual(sorted("fresh" in out for out, _ in outs), [False, True])
        self.assertEqual(len(list(self.cache.glob("offsets-*"))), 1)
        self.assertEqual(list(self.cache.glob(".*")), [])
        self.assertEqual(self.strands()[0], right)

    def test_a_kill_in_the_middle(self):
        began = time.monotonic()
        right, _, _ = self.strands()
        whole = time.monotonic() - began
        for part in (0.2, 0.35, 0.5, 0.65, 0.8):
            for path in self.cache.iterdir():
                path.unlink()
            victim = self.start("--quiet")
            time.sleep(whole * part)
            victim.kill()
            victim.communicate(timeout=100)
            strands, _, errors = self.strands()
            self.assertEqual((strands, errors), (right, ""))

    def test_a_damaged_file_costs_one_warning(self):
        right, _, _ = self.strands()
        path = next(self.cache.glob("offsets-*"))
        damaged = bytearray(path.read_bytes())
        damaged[len(damaged) // 2] ^= 16
        path.write_bytes(damaged)
        strands, out, errors = self.strands()
        self.assertEqual(strands, right)
        self.assertEqual(errors.count("\n"), 1)
        self.assertIn("warning", errors)
        self.assertIn(path.name, errors)
        self.assertEqual(self.strands()[2], "")

    def test_what_is_stale_is_said(self):
        self.assertIn("(new)", self.grow()[0])
        self.assertIn("coat: fresh", self.grow()[0])
        out = self.grow("--explain", "--set", "grooms.coat.operators.clump.amount=0.5")[0]
        self.assertIn("stale from clump (amount: 0.6 -> 0.5)", out)
        self.assertRegex(out, r"comb +fresh")
        self.assertRegex(out, r"frizz +stale: follows")

    def test_info_says_what_a_file_is(self):
        self.grow()
        for path in self.cache.iterdir():
            run = subprocess.run([PELAGE, "info", path], capture_output=True, text=True, timeout=60)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            self.assertIn(path.name.split("-")[0], run.stdout)


if __name__ == "__main__":
    unittest.main()
