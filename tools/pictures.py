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


def widest(pixels):
    spans = [max(p[c] for p in pixels) - min(p[c] for p in pixels) for c in range(3)]
    span = max(spans)
    return span * len(pixels) ** 0.5, spans.index(span), pixels


def palette_of(counts, colors):
    """Median cut of colours with the number of pixels of each: the new colours, and which one replaces each old one."""
    boxes = [widest(list(counts))]
    while len(boxes) < colors:
        boxes.sort(key=lambda box: box[0])
        size, channel, pixels = boxes[-1]
        if size == 0:
            break
        pixels.sort(key=lambda p: p[channel])
        boxes[-1:] = [widest(pixels[:len(pixels) // 2]), widest(pixels[len(pixels) // 2:])]
    palette, index = [], {}
    for _, _, pixels in boxes:
        weight = sum(counts[p] for p in pixels)
        index.update({p: len(palette) for p in pixels})
        palette.append(tuple(round(sum(p[c] * counts[p] for p in pixels) / weight) for c in range(3)))
    return palette, index


def small_png(ppm, colors=128):
    """The PNG of a binary PPM, in few colours: a third of the size, for pages of documents."""
    _, size, _, data = ppm.split(b"\n", 3)
    width, height = (int(n) for n in size.split())
    pixels = list(zip(data[0::3], data[1::3], data[2::3]))
    counts = {}
    for pixel in pixels:
        counts[pixel] = counts.get(pixel, 0) + 1
    palette, index = palette_of(counts, colors)
    rows = b"".join(b"\0" + bytes(index[p] for p in pixels[y * width:(y + 1) * width]) for y in range(height))
    return (PNG_BEGIN + png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)) +
            png_chunk(b"PLTE", bytes(c for color in palette for c in color)) +
            png_chunk(b"IDAT", zlib.compress(rows, 9)) + png_chunk(b"IEND", b""))


if __name__ == "__main__":
    for path in map(pathlib.Path, sys.argv[1:]):
        path.write_bytes(PLAIN[path.suffix](path.read_bytes()))
