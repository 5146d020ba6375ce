# SPDX-License-Identifier: Apache-2.0
"""The documents point at what is there: files exist, and hold the name that is the text of the link."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"\[([^\]]+)\]\(([^)#\s]+)(?:#[^)]*)?\)")
KEY = re.compile(r"[A-Z][A-Za-z-]+\d{2}[a-z]?")
BRACKETS = re.compile(r"\[(%s\b[^\]]*)\]" % KEY.pattern)


def documents():
    return [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/**/*.md")]


def citations(text):
    """[Key], [Key, section 2] and [Key, section 3; OtherKey, equation 4]."""
    return {key.group() for brackets in BRACKETS.findall(text) for part in re.split("[;,]", brackets)
            if (key := KEY.match(part.strip()))}


def broken_links(document, text):
    found = []
    for words, target in LINK.findall(text):
        if "://" in target:
            continue
        path = document.parent / target
        if not path.exists():
            found.append(f"{document.name}: {target} does not exist")
        elif (name := re.fullmatch(r"`(?:\w+::)*(\w+)(?:\(\))?`", words)) and path.suffix in (".h", ".cpp"):
            if not re.search(rf"\b{name.group(1)}\b", path.read_text()):
                found.append(f"{document.name}: {target} has no {name.group(1)}")
    return found


class Documents(unittest.TestCase):
    def test_links_hold(self):
        self.assertGreaterEqual(len(documents()), 5)
        self.assertEqual([], [line for path in documents() for line in broken_links(path, path.read_text())])

    def test_a_broken_link_is_noticed(self):
        here = ROOT / "README.md"
        self.assertEqual(len(broken_links(here, "[x](no/such/file.h)")), 1)
        self.assertEqual(len(broken_links(here, "[`Error`](base/error.h) [`Banana`](base/error.h)")), 1)

    def test_citations_are_understood(self):
        self.assertEqual(citations("as [Veach97, 9.2], [Ryu07; Cook07 eq. 3] but not [0, 1] or [RISPEC 3.2]"),
                         {"Veach97", "Ryu07", "Cook07"})

    def test_every_citation_has_an_entry(self):
        bibliography = (ROOT / "docs" / "references.bib").read_text()
        keys = re.findall(r"^@\w+\{([^,]+),", bibliography, re.MULTILINE)
        self.assertEqual(len(keys), len(set(keys)), "an entry is there twice")
        cited = set()
        modules = [p for p in ROOT.glob("*/CMakeLists.txt") if p.parent.name not in ("tests", "bench")]
        for folder in {p.parent for p in modules}:
            for path in folder.rglob("*"):
                if path.suffix in (".h", ".cpp"):
                    comments = "\n".join(re.findall(r"//(.*)", path.read_text()))
                    cited |= citations(comments)
        for path in documents():
            cited |= citations(LINK.sub("", path.read_text()))
        self.assertEqual(sorted(cited - set(keys)), [])


if __name__ == "__main__":
    unittest.main()
