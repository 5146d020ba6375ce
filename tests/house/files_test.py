# SPDX-License-Identifier: Apache-2.0
"""What every file of ours must look like."""
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CODE = {".h", ".cpp", ".inl", ".py", ".cmake", ".sh"}
MOST_LINES = 400
MOST_FUNCTION_LINES = 80
# Where a function begins at the left margin; a style sheet in a string begins with '@' or '.'.
FUNCTION = re.compile(r"(?!namespace|class |struct |enum |union |extern )[A-Za-z_].*[()]")


def our_files():
    """All files of the checkout; without git (a source archive), all that stand outside build folders."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "--cached", "--others", "--exclude-standard"],
                            capture_output=True, text=True)
    if listed.returncode == 0:
        paths = [ROOT / name for name in listed.stdout.splitlines()]
    else:
        paths = [p for p in ROOT.rglob("*") if not {"build", "out", ".git"} & set(p.relative_to(ROOT).parts)]
    return [p for p in paths if p.is_file()]


def our_code():
    return [path for path in our_files() if path.suffix in CODE or path.name == "CMakeLists.txt"]


class Files(unittest.TestCase):
    def assert_none(self, found):
        self.assertEqual([], [str(path.relative_to(ROOT)) for path in found])

    def test_there_are_some(self):
        self.assertGreater(len(our_code()), 50)

    def test_hold_one_idea_each(self):
        self.assert_none([p for p in our_code() if len(p.read_text().splitlines()) > MOST_LINES])

    def test_functions_are_short(self):
        """By layout: from a line at the left margin that opens a brace to the brace at the left margin."""
        long = []
        for path in our_code():
            if path.suffix not in (".h", ".cpp"):
                continue
            start = None
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if start is None and line.endswith("{") and FUNCTION.match(line):
                    start = number
                elif start is not None and line.startswith("}"):
                    if number - start >= MOST_FUNCTION_LINES:
                        long.append(f"{path.relative_to(ROOT)}:{start}")
                    start = None
        self.assertEqual([], long)

    def test_state_the_licence(self):
        self.assert_none([p for p in our_code() if p.suffix in CODE and
                          not any("SPDX-License-Identifier: Apache-2.0" in line
                                  for line in p.read_text().splitlines()[:2])])

    def test_headers_are_guarded(self):
        self.assert_none([p for p in our_code() if p.suffix == ".h" and "#pragma once" not in p.read_text()])

    def test_tests_share_no_files(self):
        """CTest runs them side by side: a fixed name in a shared folder is a race. base/temporary_folder.h gives each its own."""
        self.assert_none([p for p in our_code() if p.suffix == ".cpp" and "testing::TempDir" in p.read_text()])

    def test_sources_are_built(self):
        """A .cpp that no CMakeLists.txt names is never compiled, so nothing says when it rots."""
        listed = "".join(p.read_text() for p in our_code() if p.name == "CMakeLists.txt")
        self.assert_none([p for p in our_code() if p.suffix == ".cpp" and ROOT / "tests/consumer" not in p.parents
                          and not re.search(rf"(?<![\w-]){re.escape(p.name)}(?!\w)", listed)])


if __name__ == "__main__":
    unittest.main()
