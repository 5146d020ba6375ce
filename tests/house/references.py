# SPDX-License-Identifier: Apache-2.0
"""What documents and comments refer to: laws, documents, headings, files, scene keys, commands and flags."""
import functools
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"\[([^\]]+)\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
# A file or folder of ours, as text between backticks: with a slash inside, or a name with an ending that we use.
FILE = re.compile(r"\.?[\w-]+(?:/[\w.-]+)*/?(?:\.(?:h|cpp|py|sh|md|yaml|bib))?")
NAME_OF_A_KIND = re.compile(r"[A-Z]{3,}|out/|build/|\bmy_|yours")
LAWS = re.compile(r"\b[Ll]aws? (\d+)")
DOCUMENT = re.compile(r"(?<![\w/.-])((?:[\w.-]+/)*[\w-]+\.md)\b(?:[#,]? ?(?:section|chapter) ?(\w+))?")


def anchors(text):
    """Of all headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", FENCE.sub("", text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"[`*]", "", heading).lower()).replace(" ", "-") for heading in headings}


def broken_anchors(document, text):
    found = []
    for _, target in LINK.findall(FENCE.sub("", text)):
        file, _, anchor = target.partition("#")
        if anchor and "://" not in target:
            path = document.parent / file if file else document
            if not path.exists() or anchor not in anchors(path.read_text() if file else text):
                found.append(f"{document.name}: no heading {target}")
    return found


def comments(path, text):
    """The comments of a source file as one text, without line ends."""
    sign = "//" if path.suffix in (".h", ".cpp", ".inl", ".c") else "#"
    return " ".join(re.findall(rf"{sign}/?<?(.*)", text))


def broken_citations(name, text):
    """Laws and documents that a comment names and that do not exist."""
    laws = set(re.findall(r"^## Law (\d+)", (ROOT / "docs/LAWS.md").read_text(), re.MULTILINE))
    found = [f"{name}: no law {number}" for number in LAWS.findall(text) if number not in laws]
    for target, section in DOCUMENT.findall(text):
        places = [ROOT / target, ROOT / "docs" / target, (ROOT / name).parent / target]
        if not any(place.exists() for place in places):
            found.append(f"{name}: no document {target}")
        elif section:
            found.append(f"{name}: {target} has no numbered sections; cite a heading")
    return found


def code_spans(text):
    """Texts between backticks outside blocks of code."""
    return re.findall(r"(?<!`)`([^`\n]+)`(?!`)", FENCE.sub("", text))


def command_lines(text):
    """Command lines of blocks and of text between backticks. A line that begins with a flag continues a command."""
    lines = []
    for line in text.replace("\\\n", " ").splitlines():
        if lines and re.match(r"(?: {8,}| {2,})\[?--", line):
            lines[-1] += " " + line.strip()
        else:
            lines.append(line.strip())
    return [line for line in lines + code_spans(text) if re.match(r"(?:\./dev|(?:build/release/bin/)?pelage(?:-lab)?) \S", line)]


def missing_files(document, text):
    """Names of files and folders between backticks that are neither in the tree nor beside the document."""
    roots = {path.name for path in ROOT.iterdir() if path.name not in ("build", "out", "install")}
    found = []
    # Files that the reader makes are named in blocks of code.
    examples = "".join(FENCE.findall(text) + re.findall(r"^ {4}.*$", text, re.MULTILINE))
    for span in code_spans(text):
        if span in examples or not FILE.fullmatch(span) or NAME_OF_A_KIND.search(span):
            continue
        first = span.split("/")[0]
        if "/" in span and first in roots and not (ROOT / span).exists():
            found.append(f"{document.name}: no file {span}")
        elif "/" not in span and re.search(r"_test\.cpp$|\.(?:py|md|yaml|bib|h)$", span) and span not in names():
            found.append(f"{document.name}: no file {span}")
    return found


@functools.cache
def names():
    skip = {"build", "out", "install", ".git"}
    return {path.name for top in ROOT.iterdir() if top.name not in skip
            for path in ([top] if top.is_file() else top.rglob("*"))}


class SceneKeys:
    """The keys of scene files, as docs/MANUAL.md has them."""

    def __init__(self, manual):
        self.sections = {}
        for part in re.split(r"^## ", manual, flags=re.MULTILINE)[1:]:
            rows = re.findall(r"^\| `(\w+)` \| (.*?) \|(.*)\|$", part, re.MULTILINE)
            self.sections[part.splitlines()[0].replace(" ", "-")] = {
                key: (kind, re.findall(r"\]\(#([^)]+)\)", rest)) for key, kind, rest in rows}
        self.keys = {"include"} | {key for rows in self.sections.values() for key in rows}

    def holds(self, path):
        """Whether a dotted path leads from a scene to a key: names of things and places in lists may be anything."""
        return self.leads(["scene"], path.split("."))

    def leads(self, sections, path):
        if not path:
            return True
        for section in sections:
            if path[0] in self.sections.get(section, {}):
                if self.goes_on(*self.sections[section][path[0]], path[1:]):
                    return True
        return False

    def goes_on(self, kind, links, path):
        """Whether `path` leads on below a key of this type, whose sections are `links`."""
        if not path or any(link.endswith("field") for link in links):
            return True
        if kind.startswith("map of names"):
            return len(path) == 1 or self.leads(links, path[1:])
        if kind.startswith("list of"):
            operator = [link for link in links if link == path[0]]
            return (path[0].isdigit() or bool(operator)) and self.leads(operator or links, path[1:])
        return self.leads(links, path)

    def missing(self, document, text):
        """Dotted keys and `key: value` between backticks, and what --set sets, that no scene can have."""
        spans = code_spans(text)
        tops = set(self.sections["scene"])
        dotted = [span for span in spans
                  if re.fullmatch(r"[a-z_]+(?:\.[a-z_0-9]+)+", span) and span.split(".")[0] in tops]
        dotted += re.findall(r"--set ['\"]?([a-z_.0-9]+)=", text)
        simple = [found[1] for span in spans if (found := re.fullmatch(r"([a-z_]+): [^:]*", span))]
        return ([f"{document.name}: no scene key {key}" for key in dotted if key != "a.b.c" and not self.holds(key)] +
                [f"{document.name}: no scene key {key}" for key in simple if key not in self.keys])
