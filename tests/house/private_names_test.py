# SPDX-License-Identifier: Apache-2.0
"""Sanitizer builds compile several sources of a room as one. A private function whose name another file of the room
also uses would be an overload there, which a call may pick by mistake. Such files are listed after ALONE."""
import pathlib
import re
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PRIVATE = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.S | re.M)
FUNCTION = re.compile(r"^(?!return|else|using|class|struct|enum|template|//|#)[A-Za-z_][\w:<>,&\*\s]*?[\s&\*]([a-z_]\w*)\(", re.M)
LIST = r"^  {} (.*?)(?=^  [A-Z]|\))"


def listed(cmake, keyword):
    return {name for text in re.findall(LIST.format(keyword), cmake, re.S | re.M) for name in text.split()}


def joined_sources(folder):
    """Sources of a room, or of its tests, that sanitizer builds compile together."""
    cmake = (folder / "CMakeLists.txt").read_text()
    cmake = re.sub(r"^  (SOURCES|THREADED|STATISTICS)\n\s+", r"  \1 ", cmake, flags=re.M)
    sources = listed(cmake, "SOURCES") | listed(cmake, "THREADED")
    return sorted(name for name in sources - listed(cmake, "ALONE") if (folder / name).suffix == ".cpp")


def shared_names(folder):
    users = {}
    for source in joined_sources(folder):
        path = folder / source
        if not path.exists():
            continue
        for text in PRIVATE.findall(path.read_text()):
            for name in FUNCTION.findall(text):
                users.setdefault(name, set()).add(source)
    return [f"{folder.name}: {name}() is private in {', '.join(sorted(files))}: rename, or list files after ALONE"
            for name, files in sorted(users.items()) if len(files) > 1]


class PrivateNames(unittest.TestCase):
    def test_planted(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            text = "namespace {\n\nint f(int i) {\n  return i;\n}\n\n}  // namespace\n"
            for file in ("a.cpp", "b.cpp"):
                (folder / file).write_text(text)
            (folder / "CMakeLists.txt").write_text("pelage_library(x\n  SOURCES a.cpp b.cpp\n  DEPS base)\n")
            self.assertEqual(len(shared_names(folder)), 1)
            (folder / "CMakeLists.txt").write_text("pelage_library(x\n  SOURCES a.cpp b.cpp\n  ALONE b.cpp\n  DEPS base)\n")
            self.assertEqual(shared_names(folder), [])

    def test_rooms(self):
        rooms = [path.parent for path in sorted(ROOT.glob("*/CMakeLists.txt")) if path.parent.name not in ("tests", "bench", "build")]
        self.assertGreater(len(rooms), 10)
        problems = [problem for room in rooms + sorted(path.parent for path in ROOT.glob("tests/*/CMakeLists.txt"))
                    for problem in shared_names(room)]
        self.assertEqual(problems, [], "\n".join(problems))


if __name__ == "__main__":
    unittest.main()
