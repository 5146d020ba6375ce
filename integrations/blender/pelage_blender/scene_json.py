# SPDX-License-Identifier: Apache-2.0
"""The text of a scene as the program gets it, and where its lines are in the document. Knows nothing of Blender."""
from __future__ import annotations

import json
from typing import Any


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
