# SPDX-License-Identifier: Apache-2.0
"""OpenEXR files with numpy alone, because Blender's Python need not have a library for them (docs/OWN_CODE.md).

Reads what Pelage writes: scan lines, without compression or with ZIP. Encodes floats without compression.
"""
from __future__ import annotations

import os
import pathlib
import struct
import zlib
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

MAGIC = 20000630
TYPES: dict[int, np.dtype] = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
ROWS = {0: 1, 2: 1, 3: 16}  # number of rows that are compressed together, by compression
MAX_RATIO = 1100  # pixels may be larger than the file by this factor; the limit of ZIP is 1032
Box = tuple[int, int, int, int]


class ExrError(ValueError):
    """The file is damaged, or is not one that this module reads."""


@dataclass
class Header:
    channels: list[tuple[str, np.dtype]]  # name and type, in the order of the file
    compression: int
    data: Box  # x0, y0, x1, y1; the last two are excluded
    display: Box
    end: int  # offset of the table of blocks

    @property
    def width(self) -> int:
        return self.data[2] - self.data[0]

    @property
    def height(self) -> int:
        return self.data[3] - self.data[1]


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode("utf-8", "replace"), end + 1


def _box(value: bytes) -> Box:
    x0, y0, x1, y1 = struct.unpack("<4i", value)
    return x0, y0, x1 + 1, y1 + 1


def _channels(value: bytes) -> Iterator[tuple[str, np.dtype]]:
    at = 0
    while value[at] != 0:
        name, at = _text(value, at)
        kind, _, x_sampling, y_sampling = struct.unpack_from("<4i", value, at)
        if kind not in TYPES or x_sampling != 1 or y_sampling != 1:
            raise ExrError(f"channel '{name}' has an unknown type")
        yield name, TYPES[kind]
        at += 16


def read_header(data: bytes) -> Header:
    try:
        magic, version = struct.unpack_from("<iI", data)
        if magic != MAGIC or version & 0x1A00:
            raise ExrError("not an EXR file of scan lines in one part")
        at, found = 8, {}
        while data[at] != 0:
            name, at = _text(data, at)
            _, at = _text(data, at)
            size, = struct.unpack_from("<i", data, at)
            if size < 0 or at + 4 + size > len(data):
                raise ExrError(f"damaged EXR file: the attribute '{name}' has {size} bytes")
            found[name] = data[at + 4:at + 4 + size]
            at += 4 + size
        header = Header(list(_channels(found["channels"])), found["compression"][0], _box(found["dataWindow"]),
                        _box(found["displayWindow"]), at + 1)
        pixel_bytes = sum(kind.itemsize for _, kind in header.channels)
        if min(header.width, header.height) < 1 or header.width * header.height * pixel_bytes > MAX_RATIO * len(data):
            raise ExrError(f"damaged EXR file: {header.width} x {header.height} pixels")
        return header
    except (struct.error, IndexError, KeyError, ValueError) as error:
        raise ExrError(f"damaged EXR file: {error}") from error


def _halves(data: bytes, size: int) -> np.ndarray:
    """Inflates a ZIP block of `size` bytes and undoes its differences.

    ZIP stores the bytes at even places before those at odd places, and so does the result: the caller interleaves them.
    """
    if len(data) >= size:  # OpenEXR stores a block as it is if ZIP would not make it smaller
        plain = np.frombuffer(data, np.uint8)[:size]
        return np.concatenate([plain[0::2], plain[1::2]])
    coded = np.frombuffer(bytearray(zlib.decompress(data)), np.uint8)
    if coded.size != size:
        raise ExrError("damaged EXR file: a block has another size")
    coded[1:] -= 128  # each byte is the difference from the previous one, plus 128
    np.cumsum(coded, dtype=np.uint8, out=coded)
    return coded


def read(path: str | pathlib.Path, wanted: Callable[[str], bool] = lambda name: True
         ) -> tuple[Header, dict[str, np.ndarray]]:
    """Returns the header, and the channels (height, width) whose names are wanted, as floats; the first row is the top one."""
    data = pathlib.Path(path).read_bytes()
    header = read_header(data)
    try:
        return header, _read_channels(data, header, wanted)
    except (struct.error, ValueError, IndexError, OverflowError, zlib.error) as error:
        raise error if isinstance(error, ExrError) else ExrError(f"damaged EXR file: {error}") from error


def _read_channels(data: bytes, header: Header, wanted: Callable[[str], bool]) -> dict[str, np.ndarray]:
    if header.compression not in ROWS:
        raise ExrError(f"EXR compression {header.compression} is not supported")
    width, height = header.width, header.height
    pixels = {name: np.empty((height, width), np.float32) for name, _ in header.channels if wanted(name)}
    row_bytes = width * sum(kind.itemsize for _, kind in header.channels)
    step = ROWS[header.compression]

    def read_block(offset: int) -> None:
        y, size = struct.unpack_from("<ii", data, offset)
        top, rows = y - header.data[1], min(step, header.data[3] - y)
        if not 0 <= top < height or offset + 8 + size > len(data):
            raise ExrError("damaged EXR file: a block is outside the picture or the file")
        even, odd = _halves(data[offset + 8:offset + 8 + size], row_bytes * rows).reshape(2, rows, row_bytes // 2)
        at = 0
        for name, kind in header.channels:
            half = width * kind.itemsize // 2
            if name in pixels:
                part = np.empty((rows, 2 * half), np.uint8)
                part[:, 0::2], part[:, 1::2] = even[:, at:at + half], odd[:, at:at + half]
                pixels[name][top:top + rows] = part.view(kind)
            at += half

    offsets = struct.unpack_from(f"<{-(-height // step)}Q", data, header.end)
    with ThreadPoolExecutor(min(os.cpu_count() or 1, 16)) as pool:  # zlib and numpy let threads run side by side
        list(pool.map(read_block, offsets))
    return pixels


def encode(channels: dict[str, np.ndarray]) -> bytes:
    """A file of channels (height, width) as 32-bit floats; the first row is the top one."""
    names = sorted(channels)
    height, width = channels[names[0]].shape
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    listed = b"".join(name.encode() + b"\0" + struct.pack("<4i", 2, 0, 1, 1) for name in names) + b"\0"
    attributes = [("channels", "chlist", listed), ("compression", "compression", b"\0"), ("dataWindow", "box2i", box),
                  ("displayWindow", "box2i", box), ("lineOrder", "lineOrder", b"\0"),
                  ("pixelAspectRatio", "float", struct.pack("<f", 1)),
                  ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
                  ("screenWindowWidth", "float", struct.pack("<f", 1))]
    head = struct.pack("<iI", MAGIC, 2 | (0x400 if any(len(name) > 31 for name in names) else 0))
    for name, kind, value in attributes:
        head += name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    head += b"\0"
    row_bytes = 4 * width * len(names)
    first = len(head) + 8 * height
    table = (first + np.arange(height, dtype=np.uint64) * np.uint64(row_bytes + 8)).astype("<u8")
    rows = np.empty((height, 2 + width * len(names)), "<f4")
    rows[:, :2].view("<i4")[:, 0], rows[:, :2].view("<i4")[:, 1] = np.arange(height), row_bytes
    for index, name in enumerate(names):
        rows[:, 2 + index * width:2 + (index + 1) * width] = channels[name]
    return head + table.tobytes() + rows.tobytes()
