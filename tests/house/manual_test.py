# SPDX-License-Identifier: Apache-2.0
"""The manual: every link in it leads somewhere, every key is explained, every picture shows its example."""
import importlib.util
import pathlib
import re
import struct
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MANUAL = ROOT / "docs" / "MANUAL.md"
OPERATORS = ("length", "comb", "part", "swirl", "bend", "clump", "wet", "braid", "avoid", "curl", "frizz", "noise", "guides", "push_out", "width", "color",
             "operator mask")
FIELDS = tuple(f"{kind} field" for kind in (
    "map", "ramp", "noise", "attribute", "product", "add", "min", "mix", "sphere", "distance", "height", "region"))


def load_pictures():
    spec = importlib.util.spec_from_file_location("manual_pictures", ROOT / "tools" / "manual_pictures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def png_chunks(data):
    """Names of the chunks of a PNG."""
    names, at = [], 8
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        names.append(name.decode())
        at += 12 + length
    return names


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

    def test_every_section_has_an_example(self):
        sections = re.findall(r"^## (.+?)$(.*?)(?=^## |\Z)", self.text, re.MULTILINE | re.DOTALL)
        self.assertGreaterEqual(len(sections), 50)
        self.assertEqual([name for name, text in sections if "```yaml\n" not in text], ["fields"])  # a list of sections

    def test_pictures_show_the_examples_of_today(self):
        pictures = load_pictures()
        self.assertEqual(set(pictures.PICTURES), {*OPERATORS, *FIELDS})
        shown = re.findall(r"\]\(images/manual/(\w+\.png)\)", self.text)
        self.assertEqual(sorted(shown), sorted(pictures.picture_path(name).name for name in pictures.PICTURES))
        self.assertEqual(sorted(p.name for p in pictures.FOLDER.glob("*.png")), sorted(shown))
        old = [name for name in pictures.PICTURES
               if pictures.recorded().get(name) != pictures.scene_hash(self.text, name)]
        self.assertEqual(old, [], "run tools/manual_pictures.py build/release/bin/pelage for these")

    def test_pictures_are_small_and_hold_nothing_but_pixels(self):
        pictures = load_pictures()
        for name in pictures.PICTURES:
            data = pictures.picture_path(name).read_bytes()
            self.assertLessEqual(len(data), 20000, name)
            self.assertEqual(png_chunks(data), ["IHDR", "PLTE", "IDAT", "IEND"], name)


if __name__ == "__main__":
    unittest.main()
