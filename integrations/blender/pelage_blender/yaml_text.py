# SPDX-License-Identifier: Apache-2.0
"""Scenes as YAML for people: blocks down to those that fit on a line. Knows nothing of Blender."""
from __future__ import annotations

import json
import re
from typing import Any

WIDTH = 110
PLAIN = re.compile(r"[A-Za-z_/][A-Za-z0-9_./-]*")
WORDS = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"}


def scalar(value: Any) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.7g}"
    if isinstance(value, int):
        return str(value)
    text = str(value)
    return text if PLAIN.fullmatch(text) and text.lower() not in WORDS else json.dumps(text, ensure_ascii=False)


def flow(value: Any) -> str:
    """A value on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{scalar(k)}: {flow(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(flow(v) for v in value) + "]"
    return scalar(value)


def block(value: Any, depth: int = 0) -> str:
    """The lines of a map or list that does not fit on a line."""
    pad, lines = "  " * depth, []
    items = value.items() if isinstance(value, dict) else [(None, entry) for entry in value]
    for key, entry in items:
        head = pad + (f"{scalar(key)}:" if key is not None else "-")
        alone = key is None and isinstance(entry, dict) and len(entry) == 1  # - comb: {...}
        line = f"{head} {flow(entry)[1:-1] if alone else flow(entry)}"
        if not isinstance(entry, (dict, list)) or not entry or (depth > 0 and len(line) <= WIDTH):
            lines.append(line)
        elif key is None:
            lines.append(head + block(entry, depth + 1)[len(pad) + 1:].rstrip("\n"))
        else:
            lines.append(f"{head}\n" + block(entry, depth + 1).rstrip("\n"))
    return "\n".join(lines) + "\n"


def scene_text(document: dict[str, Any]) -> str:
    """A whole scene file."""
    return "".join(block({key: value}) for key, value in document.items())
