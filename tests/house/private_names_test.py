# SPDX-License-Identifier: Apache-2.0
"""Several sources of a module are compiled as one. Private constants and types of the same name then fail to compile, but
a private function of the same name is an overload, which a call in another source may pick by mistake."""
import pathlib
import re
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PRIVATE = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.S | re.M)
FUNCTION = re.compile(r"^(?!return|else|using|class|struct|enum|template|//|#)[A-Za-z_][\w:<>,&\*\s]*?[\s&\*]([a-z_]\w*)\(", re.M)
COMMENT_OR_STRING = re.compile(r"//[^\n]*|R\"(\w*)\(.*?\)\1\"|\"(?:\\.|[^\"\\\n])*\"", re.S)
LIST = r"^  {} (.*?)(?=^  [A-Z]|\))"


def joined_sources(folder):
    """Lists of sources of a module, or of its tests, that may be compiled together."""
    cmake = (folder / "CMakeLists.txt").read_text()
    cmake = re.sub(r"^  (SOURCES|THREADED|STATISTICS)\n\s+", r"  \1 ", cmake, flags=re.M)

    def listed(keyword):
        return {name for text in re.findall(LIST.format(keyword), cmake, re.S | re.M) for name in text.split()}

    for sources in (listed("SOURCES") | listed("THREADED"), listed("STATISTICS")):
        yield sorted(name for name in sources - listed("ALONE") if (folder / name).suffix == ".cpp" and (folder / name).exists())


def private_functions(text):
    """Those that other sources see. A test whose names are in a namespace of its own has none."""
    if "\nnamespace pelage {\n" in text:
        for private in PRIVATE.findall(text):
            yield from FUNCTION.findall(COMMENT_OR_STRING.sub("", private))


def shared_names(folder):
    for sources in joined_sources(folder):
        users = {}
        for source in sources:
            for name in private_functions((folder / source).read_text()):
                users.setdefault(name, set()).add(source)
        yield from (f"{folder.name}: {name} is private in {', '.join(sorted(files))}: rename, or list files after ALONE"
                    for name, files in sorted(users.items()) if len(files) > 1)


class PrivateNames(unittest.TestCase):
    def test_planted(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            text = "\nnamespace pelage {\nnamespace {\n\nint f(int i) {\n  return i;\n}\n\n}  // namespace\n}\n"
            (folder / "a.cpp").write_text(text)
            (folder / "b.cpp").write_text(text.replace("int i", "float i"))
            cmake = folder / "CMakeLists.txt"
            cmake.write_text("pelage_library(x\n  SOURCES a.cpp b.cpp\n  DEPS base)\n")
            self.assertEqual(len(list(shared_names(folder))), 1)
            cmake.write_text("pelage_library(x\n  SOURCES a.cpp b.cpp\n  ALONE b.cpp\n  DEPS base)\n")
            self.assertEqual(list(shared_names(folder)), [])
            cmake.write_text("pelage_test(x\n  SOURCES\n    a.cpp b.cpp\n  DEPS base)\n")
            (folder / "b.cpp").write_text(text.replace("namespace pelage", "namespace pelage::b_test"))
            self.assertEqual(list(shared_names(folder)), [])

    def test_modules(self):
        modules = [path.parent for path in sorted([*ROOT.glob("*/CMakeLists.txt"), *ROOT.glob("*/*/CMakeLists.txt")])
                   if path.relative_to(ROOT).parts[0] not in ("tests", "bench", "build")]
        self.assertGreater(len(modules), 10)
        problems = [problem for module in modules + sorted(path.parent for path in (ROOT / "tests").rglob("CMakeLists.txt")
                                                       if path.parent != ROOT / "tests")
                    for problem in shared_names(module)]
        self.assertEqual(problems, [], "\n".join(problems))


if __name__ == "__main__":
    unittest.main()
