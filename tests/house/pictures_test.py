# SPDX-License-Identifier: Apache-2.0
"""Pictures carry no metadata but their size: no text, no Exif, no path of anybody's machine."""
import pathlib
import sys
import unittest
import zlib

from files_test import our_files

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import pictures  # noqa: E402

# What else may hold a picture: the header of a .hdr is checked line by line, the others are refused.
OTHERS = {".exr", ".gif", ".tif", ".tiff", ".webp", ".bmp", ".ico", ".heic", ".avif"}


def has_metadata(path, data):
    if path.suffix.lower() == ".hdr":
        return data.split(b"\n\n")[0].split(b"\n")[1:] != [b"FORMAT=32-bit_rle_rgbe"]
    return pictures.PLAIN[path.suffix.lower()](data) != data


class Pictures(unittest.TestCase):
    def test_carry_nothing_but_their_size(self):
        found = [path for path in our_files() if path.suffix.lower() in (*pictures.PLAIN, ".hdr")]
        self.assertGreater(len(found), 10)
        # tools/pictures.py FILE removes it.
        self.assertEqual([], [str(p.relative_to(ROOT)) for p in found if has_metadata(p, p.read_bytes())])

    def test_are_of_formats_that_this_test_reads(self):
        self.assertEqual([], [str(p.relative_to(ROOT)) for p in our_files() if p.suffix.lower() in OTHERS])

    def test_planted_metadata_is_noticed_and_removed(self):
        png = pictures.PNG_BEGIN + b"".join(pictures.png_chunk(*chunk) for chunk in (
            (b"IHDR", bytes((0, 0, 0, 2, 0, 0, 0, 1, 8, 2, 0, 0, 0))), (b"IDAT", zlib.compress(bytes(7))), (b"IEND", b"")))
        jpeg = b"\xff\xd8" + pictures.JFIF + b"\xff\xdb\x00\x03\x07\xff\xda\x00\x02scan\xff\xd9"
        svg = b'<svg xmlns="http://www.w3.org/2000/svg" width="2" height="1"></svg>'
        text = pictures.png_chunk(b"tEXt", b"Software\0/home/somebody/paint")
        for name, plain, planted in (
                ("a.png", png, png[:33] + text + png[33:]),
                ("b.png", png, png + b"after the end"),
                ("a.jpg", jpeg, jpeg[:20] + b"\xff\xe1\x00\x08Exif\0\0" + jpeg[20:]),
                ("b.jpg", jpeg, jpeg[:20] + b"\xff\xfe\x00\x06path" + jpeg[20:]),
                ("a.svg", svg, svg.replace(b"></", b"><!-- made by --><metadata>who</metadata></")),
                ("b.svg", svg, svg.replace(b" width", b' inkscape:export-filename="/home/me/a.png" width'))):
            with self.subTest(name=name):
                path = pathlib.Path(name)
                self.assertFalse(has_metadata(path, plain))
                self.assertTrue(has_metadata(path, planted))
                self.assertEqual(pictures.PLAIN[path.suffix](planted), plain)
        radiance = b"#?RADIANCE\n%sFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n"
        self.assertFalse(has_metadata(pathlib.Path("a.hdr"), radiance % b""))
        self.assertTrue(has_metadata(pathlib.Path("a.hdr"), radiance % b"SOFTWARE=somebody's\n"))


if __name__ == "__main__":
    unittest.main()
