# SPDX-License-Identifier: Apache-2.0
"""references_test.py [PELAGE]: what documents and comments refer to exists; with PELAGE also its commands and flags."""
import functools
import pathlib
import re
import subprocess
import sys
import unittest

import references
from docs_test import documents
from files_test import our_code, our_files
from references import ROOT

PELAGE = sys.argv.pop() if len(sys.argv) > 1 else None


@functools.cache
def help_of(*command):
    run = subprocess.run([PELAGE, *command, "--help"], capture_output=True, text=True, timeout=60)
    return run.stdout if run.returncode == 0 else ""


def wrong_commands(document, text):
    """Commands that Pelage or ./dev does not have, and flags that the command does not have."""
    found = []
    for line in references.command_lines(text):
        words = re.sub(r"[\[\]]|(?:^|\s)#.*", " ", line).split()
        if words[0] == "./dev":
            if not re.search(rf"^  {words[1]}\b", (ROOT / "dev").read_text(), re.MULTILINE) and words[1] != "--help":
                found.append(f"{document.name}: no command {line}")
        elif PELAGE and not words[1].startswith("-"):
            page = help_of(words[1])
            flags = [word.partition("=")[0] for word in words[2:] if re.match(r"--[a-z]|-[a-z]$", word)]
            missing = [flag for flag in flags if not re.search(rf"(?<![\w-]){flag}(?![\w-])", page)]
            found += [f"{document.name}: {words[1]} has no {flag}" for flag in missing]
            if not page:
                found.append(f"{document.name}: no command {line}")
    return found


class References(unittest.TestCase):
    def of_all_documents(self, check):
        return [line for path in documents() for line in check(path, path.read_text())]

    def test_headings_that_links_name_exist(self):
        self.assertEqual([], self.of_all_documents(references.broken_anchors))

    def test_laws_and_documents_that_comments_cite_exist(self):
        sources = [path for path in our_code() if "references" not in path.name]
        cited = [(path.relative_to(ROOT), references.comments(path, path.read_text())) for path in sources]
        self.assertGreater(sum(len(references.LAWS.findall(text)) for _, text in cited), 10)
        self.assertEqual([], [line for name, text in cited for line in references.broken_citations(name, text)])

    def test_laws_that_documents_cite_exist(self):
        self.assertEqual([], self.of_all_documents(
            lambda path, text: references.broken_citations(path.relative_to(ROOT), references.LINK.sub("", text))))

    def test_files_exist(self):
        self.assertEqual([], self.of_all_documents(references.missing_files))

    def test_scene_keys_exist(self):
        keys = references.SceneKeys((ROOT / "docs/MANUAL.md").read_text())
        self.assertGreater(len(keys.keys), 100)
        self.assertEqual([], self.of_all_documents(keys.missing))

    def test_commands_and_flags_exist(self):
        self.assertEqual([], self.of_all_documents(wrong_commands))

    def test_paths_of_machines_are_nowhere(self):
        kinds = (".md", ".h", ".cpp", ".yaml", ".bib", ".txt", ".cmake")
        texts = [path for path in our_files() if path.suffix in kinds]
        pattern = re.compile(r"(?<![\w.])/(?:home|root|work)/\w")
        self.assertEqual([], [str(path.relative_to(ROOT)) for path in texts if pattern.search(path.read_text())])


class Planted(unittest.TestCase):
    """Each kind of mistake, planted."""
    HERE = ROOT / "README.md"

    def test_headings(self):
        text = "# A `b` c\n[x](#a-b-c) [y](#none) [z](docs/LAWS.md#none) [w](docs/LAWS.md)"
        found = references.broken_anchors(self.HERE, text)
        self.assertEqual(len(found), 2)

    def test_citations(self):
        text = "as law 1 says, and law 99; see docs/LAWS.md, docs/NOTHING.md and LAWS.md section 5"
        self.assertEqual(len(references.broken_citations(pathlib.Path("base/error.h"), text)), 3)

    def test_files(self):
        text = "`base/error.h` `base/nothing.h` `tests/nothing` `hash_nothing_test.cpp` `NAME.yaml` `base/` `a/b`"
        self.assertEqual(len(references.missing_files(self.HERE, text)), 3)

    def test_scene_keys(self):
        keys = references.SceneKeys((ROOT / "docs/MANUAL.md").read_text())
        good = ["render.lod.camera", "render.samples", "grooms.under.operators.clump",
                "grooms.under.operators.0.spacing", "lights.key.intensity",
                "characters.rat.transform.rotate", "grooms.a.cache.directory", "image.width"]
        bad = ["render.lod.kamera", "render.sample", "grooms.under.operators.clmup", "lights.key.intensities",
               "characters.rat.transform.rotation"]
        self.assertEqual([key for key in good if not keys.holds(key)], [])
        self.assertEqual([key for key in bad if keys.holds(key)], [])
        self.assertEqual(len(keys.missing(self.HERE, "`bounces: 4` `bounce: 4` --set render.sample=1")), 2)

    def test_commands(self):
        text = "    ./dev demo\n    ./dev dance\n    pelage render a.yaml --memory 1G\n    pelage rendre a.yaml\n" \
               "`pelage render a.yaml --memroy 1G`"
        self.assertEqual(len(wrong_commands(self.HERE, text)), 3 if PELAGE else 1)


if __name__ == "__main__":
    unittest.main()
