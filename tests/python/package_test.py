# SPDX-License-Identifier: Apache-2.0
"""The package as a whole: its types, its help, what importing it loads, and the program beside it."""
import inspect
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import pelage
from pelage import _measure, _pelage

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = pathlib.Path(pelage.__file__).parent


class Package(unittest.TestCase):
    @unittest.skipUnless(pathlib.Path("/usr/bin/mypy").exists(), "mypy is not installed")
    def test_types_are_strict(self):
        with tempfile.TemporaryDirectory() as folder:
            checked = subprocess.run(
                ["/usr/bin/mypy", "--config-file", SOURCE / "examples/python/mypy.ini", "--cache-dir", folder,
                 "--python-executable", sys.executable, SOURCE / "examples/python", PACKAGE],
                capture_output=True, text=True, check=False, env={**os.environ, "MYPYPATH": str(PACKAGE.parent)})
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_the_stub_names_what_the_module_has(self):
        stub = (PACKAGE / "_pelage.pyi").read_text(encoding="utf-8")
        for name, value in vars(_pelage).items():
            if name.startswith("_"):
                continue
            self.assertRegex(stub, rf"(?m)^(class |def )?{name}\b")
            for member in vars(value) if inspect.isclass(value) else ():
                if not member.startswith("_"):
                    self.assertRegex(stub, rf"(?m)^    (def )?{member}\b", f"{name}.{member}")

    def test_everything_public_has_help(self):
        for name in pelage.__all__:
            public = getattr(pelage, name)
            if not callable(public) or name == "Progress":
                continue
            self.assertTrue(inspect.getdoc(public), name)
            for member, value in vars(public).items() if inspect.isclass(public) else ():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    self.assertTrue(inspect.getdoc(value), f"{name}.{member}")

    def test_importing_loads_no_numpy(self):
        code = "import sys, pelage; print(sorted({'numpy', 'json', 'subprocess', 'tempfile'} & set(sys.modules)))"
        said = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, check=True).stdout
        self.assertEqual(said.strip(), "[]")

    def test_measure_returns_the_report_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "pelage"
            program.write_text(f"#!{sys.executable}\nimport json, sys\nout = sys.argv[sys.argv.index('-o') + 1]\n"
                               "if 'bad' in sys.argv: sys.stderr.write(\"a.yaml:2:9: unknown key 'widht'; did you mean 'width'?\\n"
                               "pelage: error: and 3 more\\n\"); sys.exit(3)\n"
                               "json.dump(sys.argv[1:3] + sys.argv[6:], open(out + '/report.json', 'w'))\n")
            program.chmod(0o755)
            os.environ["PELAGE_PROGRAM"] = str(program)
            self.addCleanup(os.environ.pop, "PELAGE_PROGRAM")
            report = pelage.measure("bounds", "a.yaml", set={"camera.position": [1, 2.5, 0]}, sample_counts=[1, 4])
            self.assertEqual(report, ["measure", "bounds", "--quiet", "--set", "camera.position=[1, 2.5, 0]",
                                      "--sample-counts", "1,4"])
            with self.assertRaises(pelage.Error) as caught:
                pelage.measure("bad", "a.yaml")
        error = caught.exception
        self.assertEqual((error.kind, error.file, error.line, error.column, error.nearest),
                         ("input", "a.yaml", 2, 9, "width"))
        self.assertEqual(error.problems[1].message, "and 3 more")

    def test_the_program_is_found_beside_the_package(self):
        found = pathlib.Path(_measure.program())
        if (PACKAGE.parents[1] / "bin" / "pelage").is_file():
            self.assertEqual(found, PACKAGE.parents[1] / "bin" / "pelage")


if __name__ == "__main__":
    unittest.main()
