# SPDX-License-Identifier: Apache-2.0
"""Writes what a scene consists of: its text, meshes and strands. Knows nothing of Blender's types."""
from __future__ import annotations

import hashlib
import json
import os
import pathlib
import shutil
import socket
import struct
import tempfile
from collections.abc import Callable
from typing import Any

import numpy as np

PREFIX = "pelage-blender-"
"""How the names of temporary folders begin."""


def owner_prefix() -> str:
    """How the names of the temporary folders of this machine's processes begin; computers may share a folder for them.

    Containers have numbers of processes of their own, so the name stands for both.
    """
    try:
        space = os.readlink("/proc/self/ns/pid")
    except OSError:
        space = ""
    return PREFIX + hashlib.blake2b(f"{socket.gethostname()} {space}".encode(), digest_size=6).hexdigest() + "-"


def new_folder() -> str:
    """A temporary folder whose name says which process it belongs to."""
    return tempfile.mkdtemp(prefix=f"{owner_prefix()}{os.getpid()}-")


def remove_stale_folders() -> None:
    """Removes folders of processes of this machine that are gone, which were killed."""
    prefix = owner_prefix()
    for path in pathlib.Path(tempfile.gettempdir()).glob(f"{prefix}*"):
        owner = path.name[len(prefix):].partition("-")[0]
        if owner.isdigit() and not os.path.exists(f"/proc/{owner}") and os.path.exists("/proc/self"):
            shutil.rmtree(path, ignore_errors=True)


def document_text(document: dict[str, Any]) -> str:
    """A scene as JSON, which is YAML; one value per line, so that the line of a message names the value."""
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def path_of_line(text: str, number: int) -> str:
    """Keys that lead to the value in a line of document_text(), counted from 1: `lights.Key.power`. Empty if there are none."""
    path: list[tuple[int, str]] = []
    items: dict[int, int] = {}
    for line in text.splitlines()[:number]:
        depth = len(line) - len(line.lstrip(" "))
        body = line.strip()
        while path and path[-1][0] >= depth:
            path.pop()
        if body.startswith(("}", "]")):
            continue
        if body.startswith('"') and (key := _key_of(body)) is not None:
            path.append((depth, key))
        elif depth > 0:
            items[depth] = items.get(depth, -1) + 1
            path.append((depth, str(items[depth])))
        if body.endswith(("[", "{")):
            for deeper in [d for d in items if d > depth]:
                del items[deeper]
    return ".".join(key for _, key in path)


def _key_of(body: str) -> str | None:
    try:
        key, end = json.JSONDecoder().raw_decode(body)
    except ValueError:
        return None
    return key if body[end:end + 1] == ":" else None


def _rows(pattern: str, values: np.ndarray) -> str:
    return pattern * len(values) % tuple(values.ravel().tolist())


def vertex_text(points: np.ndarray, colors: np.ndarray | None = None) -> str:
    """The v lines of an OBJ file for points (n, 3), with colours (n, 3)."""
    if colors is None:
        return _rows("v %.9g %.9g %.9g\n", points)
    return _rows("v %.9g %.9g %.9g %.6g %.6g %.6g\n", np.hstack([points, colors]))


def obj_text(points: np.ndarray, sizes: np.ndarray, corners: np.ndarray, uvs: np.ndarray | None = None,
             groups: list[tuple[str, np.ndarray]] | None = None, colors: np.ndarray | None = None) -> str:
    """The text of an OBJ file.

    points (n, 3); sizes (f,) numbers of corners of the faces, and corners (sum of sizes,) their vertices; uvs (corners, 2);
    groups: names with the indices of their faces, each face in one of them; colors (n, 3) from 0 to 1.
    """
    parts = [vertex_text(points, colors)]
    tokens, corner = corners.astype(np.int64)[:, None] + 1, " %d"
    if uvs is not None:
        unique, places = np.unique(np.ascontiguousarray(uvs, np.float32), axis=0, return_inverse=True)
        parts.append(_rows("vt %.7g %.7g\n", unique))
        tokens, corner = np.hstack([tokens, places.reshape(-1, 1) + 1]), " %d/%d"
    starts = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    for name, faces in groups or [("", np.arange(len(sizes)))]:
        if name:
            parts.append(f"usemtl {name}\n")
        for size in np.unique(sizes[faces]):
            chosen = faces[sizes[faces] == size]
            where = (starts[chosen][:, None] + np.arange(size)).ravel()
            parts.append(_rows("f" + corner * int(size) + "\n", tokens[where].reshape(len(chosen), -1)))
    return "".join(parts)


def hair_bytes(points: np.ndarray, widths: np.ndarray, counts: np.ndarray) -> bytes:
    """Strands as a .hair file of Cem Yuksel.

    points (p, 3), widths (p,) diameters, counts (n,) numbers of points of the strands, each from 2 to 65536.
    """
    same = int(counts[0]) if len(counts) and np.all(counts == counts[0]) else 0
    arrays = 2 | 4 | (0 if same else 1)  # points, thickness, and segments where they differ
    head = struct.pack("<4sIIIIff3f88s", b"HAIR", len(counts), len(points), arrays, same - 1 if same else 0,
                       0.0, 0.0, 0.5, 0.5, 0.5, b"Pelage for Blender")
    segments = b"" if same else (np.asarray(counts) - 1).astype("<u2").tobytes()
    return head + segments + np.asarray(points, "<f4").tobytes() + np.asarray(widths, "<f4").tobytes()


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
