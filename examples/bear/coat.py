# SPDX-License-Identifier: Apache-2.0
"""What grows where on the bear: length, density, colour and direction of the hair at a point of its skin."""
import math

import shape
import vec

MAX_LENGTH = 11.0    # centimetres where the map holds 1; the map stores square roots


def fade(p, centre, inner, outer):
    """1 within `inner` of a point of the left side or its mirror image, 0 beyond `outer`."""
    return vec.smoothstep(outer, inner, vec.distance((abs(p[0]), p[1], p[2]), centre))


def length(p, part):
    """In centimetres: velvet on the nose, a mane on the neck."""
    x, y, z = abs(p[0]), p[1], p[2]
    if part == "lid":
        return 0.28 + 0.5 * vec.smoothstep(1.5, 2.6, vec.distance((x, y, z), shape.eye_centre()))
    if part == "ear_back":
        return 3.8
    if part == "ear_front":
        return 3.6
    base = 0.75 + 1.05 * vec.smoothstep(20, 13, z) + 1.3 * vec.smoothstep(13, 5, z) + 1.6 * vec.smoothstep(6, -6, z)
    base += 4.0 * vec.smoothstep(-5, -20, z)
    low = vec.smoothstep(2.0, -7.0, y)
    base += low * (1.5 * vec.smoothstep(13, 6, z) + 2.2 * vec.smoothstep(6, -4, z))      # cheeks and beard
    base += 1.6 * fade(p, (11.5, -3.0, -3.0), 2.0, 8.0)
    return min(base * (1 - 0.62 * fade(p, shape.eye_centre(), 1.6, 4.6)), MAX_LENGTH)


def density(p, part):
    """0 on lips and rims and where other skin covers the head."""
    if part in ("lid", "ear_back"):
        return 1.0
    if part == "ear_front":
        return 0.7
    lips = math.exp(-((p[1] - shape.mouth_height(p[2])) / 0.4) ** 2) * vec.smoothstep(8.2, 10.0, p[2])
    pad = vec.smoothstep(1.9, 2.3, math.hypot(p[0] / 1.2, p[1] - shape.NOSE[1]) + 4 * vec.smoothstep(20.2, 18.0, p[2]))
    return (1 - lips) * pad * (1 - fade(p, shape.eye_centre(), 1.5, 1.9))


def pale(p, part):
    """0 dark brown .. 1 blond."""
    x, y, z = abs(p[0]), p[1], p[2]
    if part == "lid":
        return 0.05
    if part == "ear_back":
        return 0.35
    if part == "ear_front":
        return 0.62
    muzzle = 0.44 * vec.smoothstep(5.0, 13.0, z) * vec.smoothstep(22.5, 15.0, z)
    crown = 0.42 * vec.smoothstep(4.0, 10.0, y) * vec.smoothstep(9.0, 1.0, z)
    cheek = 0.30 * fade(p, (11.0, -2.0, -2.0), 2.0, 9.0)
    mane = 0.40 * vec.smoothstep(-6.0, -22.0, z)
    around_eye = 1 - 0.85 * fade(p, shape.eye_centre(), 1.5, 4.6)
    return min(1.0, (0.12 + max(muzzle, crown + cheek, mane)) * around_eye)


def flow(p, part):
    """Unit direction of the hair: away from the nose, around the eyes, down on the neck."""
    x, y, z = p
    side = 1 if x >= 0 else -1
    if part.startswith("ear"):
        base = (side * shape.EAR_BASE[0], shape.EAR_BASE[1] - 0.5, shape.EAR_BASE[2])
        away = vec.unit(vec.sub(p, base))
        return vec.unit(vec.add(away, (side * 0.5, 0.1, 0.0) if part == "ear_front" else (0, 0, -0.3)))
    eye = shape.eye_centre() if x >= 0 else shape.mirror(shape.eye_centre())
    away = vec.unit(vec.sub(p, (0, 0.6, 24.0)))
    face = vec.add(away, (0, 0, -0.5))
    neck = (side * 0.10, -0.55, -0.8)
    flow = vec.mix(vec.unit(face), vec.unit(neck), vec.smoothstep(3, -14, z))
    flow = vec.add(flow, (0, -0.75 * vec.smoothstep(2.0, -6.0, y) * vec.smoothstep(12, 0, z), 0))
    push = vec.sub(p, eye)
    return vec.unit(vec.add(flow, vec.scale(vec.unit(push), 1.5 * fade(p, shape.eye_centre(), 1.0, 4.0))))


def texel(p, part):
    """Values of the maps, each 0 .. 1: length, density, paleness; then the direction."""
    return (math.sqrt(length(p, part) / MAX_LENGTH), density(p, part), pale(p, part)), \
        tuple(0.5 + 0.5 * c for c in flow(p, part))
