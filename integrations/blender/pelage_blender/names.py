# SPDX-License-Identifier: Apache-2.0
"""Names in a scene of Pelage. Knows nothing of Blender."""
from __future__ import annotations


def light_name(name: str, taken: set[str]) -> str:
    """The name of a light, short enough for Blender.

    In a multilayer file, a channel has 64 bytes for view layer, light, lobe and letter: ViewLayer.light.secondary.R.
    """
    return pelage_name(name, taken, 40)


def pelage_name(name: str, taken: set[str], max_bytes: int = 1 << 16) -> str:
    """A name for Pelage that nobody has yet: without dots, which separate names there, and added to `taken`."""
    wanted = "".join("_" if c in ".,\n\r\t" else c for c in name).strip() or "unnamed"
    count, ending = 1, ""
    while (result := wanted.encode()[:max_bytes - len(ending)].decode(errors="ignore") + ending) in taken:
        count += 1
        ending = f" {count}"
    taken.add(result)
    return result
