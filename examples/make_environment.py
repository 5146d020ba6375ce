#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes examples/studio.hdr, a soft photographer's studio as a lat-long Radiance picture.

+y is up; the centre column looks along -z, columns to the right turn toward +x.
"""
import math
import pathlib

WIDTH, HEIGHT = 256, 128

# Softboxes and windows: direction of the centre, half width and half height in degrees, softness of the edge
# in degrees, radiance
PANELS = [
    ((0.10, 1.00, 0.15), 32, 26, 10, (4.6, 4.5, 4.4)),       # overhead softbox
    ((0.84, 0.30, 0.46), 15, 20, 4, (6.5, 7.2, 8.4)),        # window, cool, camera right
    ((-0.75, 0.30, -0.80), 12, 30, 6, (5.6, 4.8, 4.0)),      # warm strip behind, for the rim of the fur
]
WINDOW_BARS = 1      # the panel crossed by glazing bars
ZENITH, HORIZON, FLOOR = (0.42, 0.43, 0.46), (0.30, 0.29, 0.28), (0.20, 0.15, 0.11)


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def direction(column, row):
    """Centre of a texel; row 0 is the top."""
    azimuth = (column + 0.5) / WIDTH * 2 * math.pi - math.pi
    polar = (row + 0.5) / HEIGHT * math.pi
    return (math.sin(polar) * math.sin(azimuth), math.cos(polar), -math.sin(polar) * math.cos(azimuth))


def unit(v):
    n = math.sqrt(sum(x * x for x in v))
    return tuple(x / n for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def panel_cover(d, centre, half_width, half_height, softness):
    """(how much the panel covers direction d, place across it, place up it) with places in -1 .. 1."""
    forward = unit(centre)
    across = unit(cross(forward, (0, 0, 1) if abs(forward[1]) > 0.9 else (0, 1, 0)))
    up = cross(across, forward)
    ahead = dot(d, forward)
    if ahead <= 0.05:
        return 0.0, 0.0, 0.0
    x = math.degrees(math.atan2(dot(d, across), ahead))
    y = math.degrees(math.atan2(dot(d, up), ahead))
    cover = (smoothstep(half_width + softness, half_width - softness, abs(x))
             * smoothstep(half_height + softness, half_height - softness, abs(y)))
    return cover, x / half_width, y / half_height


def radiance(d):
    height = d[1]
    wall = mix(HORIZON, ZENITH, smoothstep(0.0, 0.8, height))
    color = mix(wall, FLOOR, smoothstep(0.06, -0.12, height))
    color = mix(color, tuple(0.55 * c for c in FLOOR), smoothstep(-0.4, -1.0, height))
    for i, (centre, half_width, half_height, softness, light) in enumerate(PANELS):
        cover, x, y = panel_cover(d, centre, half_width, half_height, softness)
        if i == WINDOW_BARS:
            bar = min(abs(x), abs(abs(y) - 0.4))
            cover *= 0.12 + 0.88 * smoothstep(0.03, 0.09, bar)
        color = mix(color, light, cover)
    return color


def rgbe(color):
    largest = max(color)
    if largest < 1e-32:
        return (0, 0, 0, 0)
    mantissa, exponent = math.frexp(largest)
    scale = mantissa * 256 / largest
    return tuple(min(int(c * scale), 255) for c in color) + (exponent + 128,)


def main():
    path = pathlib.Path(__file__).resolve().parent / "studio.hdr"
    data = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH))
    for row in range(HEIGHT):
        pixels = [rgbe(radiance(direction(column, row))) for column in range(WIDTH)]
        data += bytes((2, 2, WIDTH >> 8, WIDTH & 255))       # new run-length scheme, each channel apart
        for channel in range(4):
            values = [p[channel] for p in pixels]
            data += run_lengths(values)
    path.write_bytes(data)


def run_lengths(values):
    """Radiance's scheme: a count above 128 repeats the next byte, below it copies that many bytes."""
    out, i = bytearray(), 0
    while i < len(values):
        run = 1
        while i + run < len(values) and run < 127 and values[i + run] == values[i]:
            run += 1
        if run >= 3:
            out += bytes((128 + run, values[i]))
            i += run
            continue
        start = i
        while i < len(values) and i - start < 128 and values[i:i + 3] != [values[i]] * 3:
            i += 1
        out += bytes((i - start,)) + bytes(values[start:i])
    return out


if __name__ == "__main__":
    main()
