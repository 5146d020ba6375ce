# SPDX-License-Identifier: Apache-2.0
"""Sanitizer builds compile several sources of a module as one. There, private constants, types and aliases of the same name
do not compile (except for two equal aliases), and a private function of the same name is an overload, which a call may
pick by mistake. Such files are listed after ALONE."""
import pathlib
import re
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PRIVATE = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.S | re.M)
FUNCTION = re.compile(r"^(?!return|else|using|class|struct|enum|template|//|#)[A-Za-z_][\w:<>,&\*\s]*?[\s&\*]([a-z_]\w*)\(", re.M)
TYPE = re.compile(r"^(?:class|struct|union|enum(?: class)?) (\w+)", re.M)
ALIAS = re.compile(r"^using (\w+) = ([^;]*);", re.M)
CONSTANT = re.compile(r"^(?:inline |static )*(?:constexpr|const|constinit) ([^;]*?);", re.S | re.M)
COMMENT_OR_STRING = re.compile(r"//[^\n]*|R\"(\w*)\(.*?\)\1\"|\"(?:\\.|[^\"\\\n])*\"", re.S)
ENUMERATORS = re.compile(r"^enum (?!class)[^{;]*\{([^}]*)\}", re.M)
LIST = r"^  {} (.*?)(?=^  [A-Z]|\))"


def listed(cmake, keyword):
    return {name for text in re.findall(LIST.format(keyword), cmake, re.S | re.M) for name in text.split()}


def joined_sources(folder):
    """Sources of a module, or of its tests, that sanitizer builds compile together."""
    cmake = (folder / "CMakeLists.txt").read_text()
    cmake = re.sub(r"^  (SOURCES|THREADED|STATISTICS)\n\s+", r"  \1 ", cmake, flags=re.M)
    sources = listed(cmake, "SOURCES") | listed(cmake, "THREADED")
    return sorted(name for name in sources - listed(cmake, "ALONE") if (folder / name).suffix == ".cpp")


def without_nested(text):
    """The text without anything in brackets; angle brackets with = or ; between them are comparisons."""
    for pattern in (r"\{[^{}]*\}", r"\([^()]*\)", r"\[[^][]*\]", r"<[^<>;=]*>"):
        before = None
        while before != text:
            before, text = text, re.sub(pattern, "", text)
    return text


def declared(statement):
    """Names that a statement declares: those before = or a comma, or at its end. None if it is part of a function."""
    flat = without_nested(statement).strip()
    return [] if re.search(r"[{(]", flat) else re.findall(r"(\w+)\s*(?:=[^,]*)?(?:,|$)", flat)


def private_names(text):
    """Pairs of a name and, for an alias, what it stands for."""
    for private in PRIVATE.findall(text):
        private = COMMENT_OR_STRING.sub("", private)
        names = FUNCTION.findall(private) + TYPE.findall(private)
        for statement in CONSTANT.findall(private) + ENUMERATORS.findall(private):
            names += declared(statement)
        yield from ((name, None) for name in names)
        yield from ALIAS.findall(private)


def shared_names(folder):
    users, meanings = {}, {}
    for source in joined_sources(folder):
        path = folder / source
        if not path.exists():
            continue
        for name, meaning in private_names(path.read_text()):
            users.setdefault(name, set()).add(source)
            meanings.setdefault(name, set()).add(meaning)
    return [f"{folder.name}: {name} is private in {', '.join(sorted(files))}: rename, or list files after ALONE"
            for name, files in sorted(users.items()) if len(files) > 1 and (meanings[name] == {None} or len(meanings[name]) > 1)]


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

    def shared(self, first, second):
        """Names that two files share."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for file, text in (("a.cpp", first), ("b.cpp", second)):
                (folder / file).write_text(f"namespace {{\n\n{text}\n\n}}  // namespace\n")
            (folder / "CMakeLists.txt").write_text("pelage_library(x\n  SOURCES a.cpp b.cpp\n  DEPS base)\n")
            return [problem.split()[1] for problem in shared_names(folder)]

    def test_planted_constants_and_types(self):
        file = """constexpr size_t kA = f(1, 2), kB = size_t(1) << 3;  // kC, kD
const std::map<int, float> kMap{{1, 2}};
constexpr std::array<int, 2> kList = {{1, 2}};
const char* const kText = "a, b;";
struct S {
  int inner = 0;
};
enum class E { kInner };
enum Plain : size_t {
  kFirst,
  kLast = kFirst + 1
};
using Same = std::vector<int>;
const S& f(int i) {
  const int local = i;
  return s;
}"""
        self.assertEqual(self.shared(file, file),
                         ["E", "Plain", "S", "f", "kA", "kB", "kFirst", "kLast", "kList", "kMap", "kText"])
        self.assertEqual(self.shared("using A = int;", "using A = long;"), ["A"])
        self.assertEqual(self.shared("using A = int;", "struct A;"), ["A"])
        self.assertEqual(self.shared("constexpr int kA = 1;", "constexpr int kB = kA;"), [])

    def test_modules(self):
        modules = [path.parent for path in sorted(ROOT.glob("*/CMakeLists.txt")) if path.parent.name not in ("tests", "bench", "build")]
        self.assertGreater(len(modules), 10)
        problems = [problem for module in modules + sorted(path.parent for path in ROOT.glob("tests/*/CMakeLists.txt"))
                    for problem in shared_names(module)]
        self.assertEqual(problems, [], "\n".join(problems))


if __name__ == "__main__":
    unittest.main()
