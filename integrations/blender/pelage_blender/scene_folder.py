# SPDX-License-Identifier: Apache-2.0
"""The folder that holds a scene and its files. Knows nothing of Blender."""
from __future__ import annotations

import hashlib
import os
import pathlib
from collections.abc import Callable
from typing import Any

import numpy as np


class SceneFolder:
    """A folder of files that are written only where their content changes, so that a program that watches them sees edits."""

    def __init__(self, path: pathlib.Path) -> None:
        self.path, self._digests, self._sources = path, dict[str, bytes](), dict[str, bytes]()

    def put(self, name: str, content: str | bytes) -> str:
        """Writes a file, whole or not at all, unless it has this content already; returns its name."""
        data = content.encode() if isinstance(content, str) else content
        digest = hashlib.blake2b(data, digest_size=16).digest()
        self._sources.pop(name, None)
        if self._digests.get(name) != digest:
            temporary = self.path / (name + ".part")
            temporary.write_bytes(data)
            os.replace(temporary, self.path / name)
            self._digests[name] = digest
        return name

    def put_made(self, name: str, source: list[Any], make: Callable[[], str]) -> str:
        """As put(), of a text that depends on arrays and plain values alone: it is made only if one of these has changed.

        Making the text of a mesh takes far longer than comparing its arrays.
        """
        digest = hashlib.blake2b(digest_size=16)
        for part in source:
            if isinstance(part, np.ndarray):
                digest.update(f"{part.dtype} {part.shape}".encode())
                digest.update(np.ascontiguousarray(part).data)
            else:
                digest.update(repr(part).encode())
        if self._sources.get(name) != digest.digest():
            self.put(name, make())
            self._sources[name] = digest.digest()
        return name
