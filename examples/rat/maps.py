# SPDX-License-Identifier: Apache-2.0
"""Bakes the coat into 8-bit maps on the cage's texture coordinates."""
import coat
import mesh as meshes
import png
import vec
from charts import SIZE

DILATION = 8     # texels by which every chart is widened, so that filtered lookups stay clean
TINT_RANGE = 2.0

# map: first channel and number of channels, in the row of values of a texel
MAPS = {"length": (0, 1), "density": (1, 3), "direction": (4, 3), "tint": (7, 3), "skin": (10, 3), "whiskers": (13, 3)}


def smooth_values(p, n, part):
    """What may be interpolated between the points of the subdivided skin, each 0 .. 1."""
    direction = [0.5 + 0.5 * x for x in coat.flow(p, n, part)]
    tint = [x / TINT_RANGE for x in coat.tint(p, n, part)]
    return (coat.length(p, n, part), *coat.density(p, n, part), *direction, *tint)


def fine_values(p, n, part):
    """What has finer detail than the subdivided skin."""
    return (*coat.skin(p, n, part), *coat.whiskers(p, part))


def patches(mesh, atlas, smooth, steps=2):
    """The subdivided skin: yields (part, texel corners, values + positions + normals there) of each small quad."""
    points, quads = mesh.points, [f.vertices for f in mesh.faces]
    texels = [[atlas.texel(f.chart, c) for c in f.corners] for f in mesh.faces]
    for _ in range(steps):
        points, quads = meshes.subdivide(points, quads)
        texels = [split for corners in texels for split in split_quad(corners)]
    normals = meshes.vertex_normals(points, quads)
    known = {}
    for i, (quad, corners) in enumerate(zip(quads, texels)):
        part = mesh.faces[i >> (2 * steps)].group
        values = []
        for v in quad:
            if (v, part) not in known:
                known[v, part] = smooth(points[v], normals[v], part) + points[v] + normals[v]
            values.append(known[v, part])
        yield part, corners, values


def split_quad(corners):
    """The four quarters of a quad, in the order of mesh.subdivide."""
    centre = vec.mix(vec.mix(corners[0], corners[1], 0.5), vec.mix(corners[2], corners[3], 0.5), 0.5)
    middles = [vec.mix(corners[i], corners[(i + 1) % 4], 0.5) for i in range(4)]
    return [(corners[i], middles[i], centre, middles[i - 1]) for i in range(4)]


def bake(mesh, atlas, smooth, fine):
    """A row of values per texel, bottom row first; None outside the charts and their surroundings.

    `smooth(point, normal, part)` is asked at the points of the subdivided skin, `fine(point, normal, part)`
    per texel.
    """
    image = [None] * (SIZE * SIZE)
    for part, corners, values in patches(mesh, atlas, smooth):
        a, b, c, d = corners
        along = max(1, round(1.6 * max(abs(b[0] - a[0]) + abs(b[1] - a[1]), abs(c[0] - d[0]) + abs(c[1] - d[1]))))
        across = max(1, round(1.6 * max(abs(d[0] - a[0]) + abs(d[1] - a[1]), abs(c[0] - b[0]) + abs(c[1] - b[1]))))
        for i in range(along):
            s = (i + 0.5) / along
            near, far = vec.mix(a, b, s), vec.mix(d, c, s)
            near_values = far_values = None
            for j in range(across):
                t = (j + 0.5) / across
                at = int(near[1] + (far[1] - near[1]) * t) * SIZE + int(near[0] + (far[0] - near[0]) * t)
                if image[at] is None:
                    if near_values is None:
                        near_values, far_values = vec.mix(values[0], values[1], s), vec.mix(values[3], values[2], s)
                    value = vec.mix(near_values, far_values, t)
                    image[at] = value[:-6] + fine(value[-6:-3], vec.unit(value[-3:]), part)
    dilate(image)
    return image


def dilate(image):
    front = [i for i, value in enumerate(image) if value is not None]
    for _ in range(DILATION):
        reached = []
        for i in front:
            x = i % SIZE
            for j, inside in ((i - 1, x > 0), (i + 1, x < SIZE - 1), (i - SIZE, i >= SIZE),
                              (i + SIZE, i < SIZE * (SIZE - 1))):
                if inside and image[j] is None:
                    image[j] = image[i]
                    reached.append(j)
        front = reached


def write(folder, mesh, atlas):
    folder.mkdir(exist_ok=True)
    image = bake(mesh, atlas, smooth_values, fine_values)
    rows = [image[y * SIZE:(y + 1) * SIZE] for y in range(SIZE - 1, -1, -1)]
    for name, (first, channels) in MAPS.items():
        pixels = bytearray()
        for row in rows:
            for values in row:
                chosen = values[first:first + channels] if values else (0.0,) * channels
                pixels += bytes(min(max(round(255 * v), 0), 255) for v in chosen)
        png.write(folder / (name + ".png"), SIZE, SIZE, channels, bytes(pixels))
