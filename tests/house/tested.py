# SPDX-License-Identifier: Apache-2.0
"""Where each source file is tested: by a test of its name, or where a line in it says."""
import functools
import pathlib
import re

from rooms import INCLUDE, read_rooms

SAYS = re.compile(r"^// Tested in (tests/\S+)\.$", re.MULTILINE)
LOGIC = re.compile(r"\b(for|if|while|switch) (constexpr )?\(")
COMMENT = re.compile(r"//.*")


class Tree:
    def __init__(self, root):
        self.root = root
        self.rooms = read_rooms((root / "docs" / "ARCHITECTURE.md").read_text())

    @functools.lru_cache(maxsize=None)
    def text(self, name):
        path = self.root / name
        return path.read_text() if path.is_file() else None

    def sources(self):
        """All .cpp files of the rooms, and headers that stand alone and loop or branch, or say where they are tested."""
        found = []
        for room in self.rooms:
            for path in sorted((self.root / room).rglob("*")):
                name = path.relative_to(self.root).as_posix()
                if name == "cli/main.cpp":
                    continue
                if path.suffix == ".cpp" or (path.suffix == ".h" and not path.with_suffix(".cpp").exists() and
                                             (SAYS.search(self.text(name)) or
                                              LOGIC.search(COMMENT.sub("", self.text(name))))):
                    found.append(name)
        return found

    @functools.lru_cache(maxsize=None)
    def includes(self, name):
        return [match.group(2) for line in (self.text(name) or "").splitlines()
                if (match := INCLUDE.match(line)) and match.group(1) == '"']

    @functools.lru_cache(maxsize=None)
    def headers_of(self, name):
        """What declares the functions of a source: its own header, or else some that it includes of its folder."""
        own = re.sub(r"\.cpp$", ".h", name)
        if self.text(own) is not None:
            return {own}
        folder = name.rsplit("/", 1)[0]
        return {header for header in self.includes(name) if header.rsplit("/", 1)[0] == folder}

    @functools.lru_cache(maxsize=None)
    def sources_of(self, header):
        """The source of a header's name; those without a header of their own count to each that may declare them."""
        own = re.sub(r"\.h$", ".cpp", header)
        folder = (self.root / header).parent
        found = {own} if self.text(own) is not None else set()
        if folder.is_dir() and not header.startswith("tests/"):
            for path in folder.glob("*.cpp"):
                name = path.relative_to(self.root).as_posix()
                if header in self.headers_of(name):
                    found.add(name)
        return found

    def included_by_test(self, test):
        """Headers that a test includes, itself or by headers of the tests."""
        found, waiting = set(), [test]
        while waiting:
            for header in self.includes(waiting.pop()):
                if header not in found:
                    found.add(header)
                    if header.startswith("tests/"):
                        waiting.append(header)
        return found

    @functools.lru_cache(maxsize=None)
    def reached_by(self, test):
        """Headers of everything that a test uses: includes of headers, and of the sources that belong to them."""
        found, waiting = set(), list(self.included_by_test(test))
        while waiting:
            header = waiting.pop()
            if header in found:
                continue
            found.add(header)
            waiting += self.includes(header)
            for source in self.sources_of(header):
                waiting += self.includes(source)
        return found

    def uses(self, test, source):
        """A test of another room includes the header; one of the same room may reach it through others.

        Those of cli/ run whole commands, and so all of lab/ too. Those in Python run the program: those of view/ also
        run its command.
        """
        where, room = test.split("/")[1], source.split("/")[0]
        if test.endswith(".py"):
            return (where, room) in (("cli", "cli"), ("cli", "lab"), ("view", "view"), ("view", "cli"))
        headers = self.headers_of(source)
        if headers & self.included_by_test(test):
            return True
        return (where == room or (where, room) == ("cli", "lab")) and bool(headers & self.reached_by(test))

    def untested(self):
        """One line for each source that no test of its name tests, nor one that it names."""
        found = []
        for source in self.sources():
            said = SAYS.findall(self.text(source))
            own = f"tests/{source.rsplit('.', 1)[0]}_test.cpp"
            if self.text(own) is not None:
                found += [f"{source}: {own} is there; the line is not needed"] if said else []
                continue
            if not said:
                found.append(f"{source}: neither {own} nor a line '// Tested in tests/....'")
            for test in said:
                if self.text(test) is None:
                    found.append(f"{source}: {test} does not exist")
                elif not self.uses(test, source):
                    found.append(f"{source}: {test} does not use it")
        return found

    def misplaced(self):
        """Tests below tests/ROOM/FOLDER/ for which there is no ROOM/FOLDER/."""
        return [path.relative_to(self.root).as_posix()
                for room in self.rooms for path in sorted((self.root / "tests" / room).rglob("*_test.cpp"))
                if not (self.root / path.relative_to(self.root / "tests")).parent.is_dir()]
