# SPDX-License-Identifier: Apache-2.0
"""The points of particle hair.

ParticleSystem.co_hair() takes ten microseconds for a point. On Linux, the same points are read from Blender's own memory by
way of /proc/self/mem, where a wrong address is an error and no crash. The addresses that Blender's Python knows are compared
before, and all points of 24 strands with co_hair() after; if one differs, co_hair() reads everything.
"""
from __future__ import annotations

import os
from typing import Any

import bpy
import numpy as np

POINTER = np.dtype("<u8")
KEY_FLOATS = 15  # ParticleCacheKey: co[3], vel[3], rot[4], col[3], time, segments (an int)


def _read(memory: int, address: int, count: int, kind: Any) -> np.ndarray:
    size = count * np.dtype(kind).itemsize
    data = os.pread(memory, size, address)
    if len(data) != size:
        raise OSError("cannot be read")
    return np.frombuffer(data, kind)


def _cache_pointers(memory: int, system: Any, numbers: range) -> np.ndarray:
    """Addresses of the cached paths of strands, if the structure is the one that is known."""
    head = _read(memory, system.as_pointer(), 9, POINTER)
    parents = len(system.particles)
    known = [(2, system.settings.as_pointer())]
    if parents:
        known.append((3, system.particles[0].as_pointer()))
    if len(system.child_particles):
        known.append((4, system.child_particles[0].as_pointer()))
    if any(int(head[index]) != address for index, address in known):
        raise OSError("another layout")
    parts = []
    if numbers.start < parents:
        parts.append(_read(memory, int(head[7]), min(parents, numbers.stop) - numbers.start, POINTER))
    if numbers.stop > parents:
        parts.append(_read(memory, int(head[8]), numbers.stop - parents, POINTER))
    return np.concatenate(parts)


def _keys_from_memory(system: Any, numbers: range, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, steps + 1, 3) as Blender caches them, and the number of segments of each strand (n,)."""
    memory = os.open("/proc/self/mem", os.O_RDONLY)
    try:
        pointers = _cache_pointers(memory, system, numbers).astype(np.int64)
        size = 4 * KEY_FLOATS * (steps + 1)
        keys = np.empty((len(pointers), steps + 1, KEY_FLOATS), np.float32)
        ends = np.flatnonzero(np.diff(pointers) != size) + 1  # paths lie one behind the other, in pieces
        for first, last in zip(np.concatenate([[0], ends]), np.concatenate([ends, [len(pointers)]])):
            keys[first:last] = _read(memory, int(pointers[first]), keys[first:last].size, "<f4").reshape(-1, steps + 1,
                                                                                                      KEY_FLOATS)
    finally:
        os.close(memory)
    return keys[..., :3], keys[:, 0, 14].view(np.int32).copy()


def _checked(ob: bpy.types.Object, system: Any, numbers: range, keys: np.ndarray, segments: np.ndarray) -> None:
    """Raises if the keys of some strands are not those of co_hair()."""
    steps = keys.shape[1] - 1
    if segments.max(initial=0) > steps or segments.min(initial=0) < -1:
        raise OSError("another layout")
    if not np.isfinite(keys[np.arange(steps + 1) <= segments[:, None]]).all():
        raise OSError("points that are not numbers")
    for place in np.unique(np.linspace(0, len(numbers) - 1, 24).astype(int)):
        for step in range(max(int(segments[place]), 0) + 1):
            point = np.array(system.co_hair(ob, particle_no=numbers[place], step=step))
            if not np.abs(point - keys[place, step]).max() <= 1e-4 * (1 + np.abs(point).max()):
                raise OSError("other points")


def keys_by_calls(ob: bpy.types.Object, system: Any, numbers: range, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """The slow truth: as _keys_from_memory(), by a call for each point."""
    co_hair = system.co_hair
    flat = [c for i in numbers for j in range(steps + 1) for c in co_hair(ob, particle_no=i, step=j)]
    keys = np.array(flat, np.float32).reshape(len(numbers), steps + 1, 3)
    there = np.any(keys != 0, axis=2)  # co_hair() returns 0, 0, 0 beyond the end of a strand
    return keys, (there * np.arange(steps + 1)).max(axis=1).astype(np.int32)


def read_keys(ob: bpy.types.Object, system: Any, numbers: range, steps: int) -> tuple[np.ndarray, np.ndarray]:
    try:
        keys, segments = _keys_from_memory(system, numbers, steps)
        _checked(ob, system, numbers, keys, segments)
        return keys, segments
    except (OSError, ValueError, OverflowError):
        return keys_by_calls(ob, system, numbers, steps)
