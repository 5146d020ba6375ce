# SPDX-License-Identifier: Apache-2.0
"""Three-component vectors as plain tuples."""
import math


def add(*vectors):
    return tuple(map(sum, zip(*vectors)))


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def along(origin, direction, distance):
    """The point `distance` times `direction` away from `origin`."""
    return (origin[0] + direction[0] * distance,
            origin[1] + direction[1] * distance,
            origin[2] + direction[2] * distance)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def distance(a, b):
    return length(sub(a, b))


def unit(a):
    n = length(a)
    return scale(a, 1 / n) if n > 0 else (0.0, 0.0, 0.0)


def mix(a, b, t):
    """Linear blend of two tuples of any one size."""
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def mean(vectors):
    vectors = list(vectors)
    return scale(add(*vectors), 1 / len(vectors))


def smoothstep(low, high, x):
    """0 below `low`, 1 above `high`, smooth between; falls instead if low > high."""
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def bump(a, centre, radius):
    """A bell of height 1 around `centre`, gone at about twice `radius`."""
    d = sub(a, centre)
    return math.exp(-dot(d, d) / (radius * radius))
