# SPDX-License-Identifier: Apache-2.0
"""The manual: every link in it leads somewhere, every section is one, every key is explained."""
import pathlib
import re
import unittest

MANUAL = pathlib.Path(__file__).resolve().parents[2] / "docs" / "MANUAL.md"


class Manual(unittest.TestCase):
    def setUp(self):
        self.text = MANUAL.read_text()

    def test_links_lead_to_sections(self):
        sections = {name.replace(" ", "-") for name in re.findall(r"^## (.+)$", self.text, re.MULTILINE)}
        links = set(re.findall(r"\]\(#([^)]+)\)", self.text))
        self.assertGreaterEqual(len(links), 20)
        self.assertEqual(links - sections, set())

    def test_sections_have_names_of_their_own(self):
        sections = re.findall(r"^## (.+)$", self.text, re.MULTILINE)
        self.assertEqual(len(sections), len(set(sections)))

    def test_every_key_is_explained(self):
        rows = re.findall(r"^\| `(\w+)` \|(.+)\|$", self.text, re.MULTILINE)
        self.assertGreaterEqual(len(rows), 100)
        self.assertEqual([key for key, row in rows if len(row.split(" | ")[-1].strip()) < 4], [])


if __name__ == "__main__":
    unittest.main()
