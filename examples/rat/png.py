# SPDX-License-Identifier: Apache-2.0
"""Writes 8-bit PNG files."""
import struct
import zlib

COLOR_TYPE = {1: 0, 3: 2}    # PNG's names for grey and RGB


def write(path, width, height, channels, pixels):
    """`pixels`: bytes, top row first, `channels` (1 or 3) per pixel."""
    stride = width * channels
    rows = b"".join(b"\0" + pixels[y * stride:(y + 1) * stride] for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, COLOR_TYPE[channels], 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
