#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""pictures.py FILE...: removes from PNG, JPEG and SVG files everything but the picture and its size."""
import pathlib
import re
import struct
import sys
import zlib

PNG_CHUNKS = {b"IHDR", b"PLTE", b"tRNS", b"IDAT", b"IEND"}
PNG_BEGIN = b"\x89PNG\r\n\x1a\n"
JFIF = b"\xff\xe0\x00\x10JFIF\x00\x01\x01\x00\x00\x01\x00\x01\x00\x00"


def png_chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def plain_png(data):
    result, at = data[:8], 8
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        if name in PNG_CHUNKS:
            result += data[at:at + 12 + length]
        at += 12 + length
        if name == b"IEND":
            break
    return result


def plain_jpeg(data):
    """Keeps tables and scans; of the application segments only a JFIF header without density and thumbnail."""
    result, at = data[:2] + JFIF, 2
    while data[at + 1] != 0xDA:
        length = struct.unpack(">H", data[at + 2:at + 4])[0]
        if not 0xE0 <= data[at + 1] <= 0xEF and data[at + 1] != 0xFE:
            result += data[at:at + 2 + length]
        at += 2 + length
    return result + data[at:data.rindex(b"\xff\xd9") + 2]


def plain_svg(data):
    text = re.sub(r"<!--.*?-->|<metadata\b.*?</metadata>|<\?(?!xml\b).*?\?>", "", data.decode(), flags=re.DOTALL)
    return re.sub(r"\s(?:xmlns:)?(?:inkscape|sodipodi)(?::[\w-]+)?=\"[^\"]*\"", "", text).encode()


PLAIN = {".png": plain_png, ".jpg": plain_jpeg, ".jpeg": plain_jpeg, ".svg": plain_svg}


if __name__ == "__main__":
    for path in map(pathlib.Path, sys.argv[1:]):
        path.write_bytes(PLAIN[path.suffix](path.read_bytes()))
