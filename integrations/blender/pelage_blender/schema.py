# SPDX-License-Identifier: Apache-2.0
"""The operators of a groom and their keys, as the program states them: the panel is built from `pelage manual`.

Knows nothing of Blender's types.
"""
from __future__ import annotations

import functools
import os
import re
import subprocess
import time
from dataclasses import dataclass

from .process import PelageFailed

ROW = re.compile(r"\| `([a-z_]+)` \|(.*)\|$")
ENDLESS = 1e30
DIRECTIONS = {"direction", "gravity"}
"""Keys with a direction, which the panel shows with z up."""
POINTS = {"center"}
UNWANTED = {"guides", "color", "part", "python", "avoid", "operator mask"}
"""Blocks that the panel does not offer: guides and colours belong to the coat; lines, modules and meshes are not numbers."""
FAILURE_S = 20.0
"""How long a program that has failed is not asked again."""


@dataclass(frozen=True)
class SchemaKey:
    name: str
    kind: str           # number, integer, field, vector, color, choice, switch, or other
    default: object     # a number, a tuple, text or bool; None: the key may be left out
    low: float
    high: float
    help: str
    choices: tuple[str, ...] = ()

    @property
    def takes_maps(self) -> bool:
        return self.kind == "field"


@dataclass(frozen=True)
class SchemaBlock:
    name: str
    help: str
    keys: tuple[SchemaKey, ...]

    def key(self, name: str) -> SchemaKey | None:
        return next((key for key in self.keys if key.name == name), None)


def _cells(row: str) -> list[str]:
    return [cell.strip().replace("\\|", "|").replace("\\<", "<") for cell in re.split(r"(?<!\\)\|", row)]


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _vector(text: str) -> tuple[float, ...] | None:
    parts = text.strip("[]").split(",") if text.startswith("[") else []
    values = [_number(part) for part in parts]
    return tuple(v for v in values if v is not None) if len(values) == 3 and None not in values else None


def _limits(text: str) -> tuple[float, float]:
    """`0 .. 1`, `> 0, <= 1`, `>= 0` or nothing. An excluded limit is kept at a small distance."""
    if ".." in text:
        low, high = (float(part) for part in text.split(".."))
        return low, high
    low, high = -ENDLESS, ENDLESS
    for sign, number in re.findall(r"([<>]=?) (\S+?)(?:,|$)", text):
        value = float(number)
        if sign.startswith(">"):
            low = value if sign == ">=" else value + 1e-6
        else:
            high = value
    return low, high


def _key(name: str, cells: list[str]) -> SchemaKey:
    kind, default, limits, _, help_text = (cells + [""] * 5)[:5]
    low, high = _limits(limits)
    help_text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", help_text).replace("`", "").replace(" See fields.", "")
    number, vector = _number(default), _vector(default)
    if kind == "true or false":
        return SchemaKey(name, "switch", default == "true", 0, 1, help_text)
    if kind == "integer":
        return SchemaKey(name, "integer", None if number is None else int(number), low, high, help_text)
    if kind in ("number", "field") and vector is None:
        return SchemaKey(name, kind, number, low, high, help_text)
    if kind in ("3 numbers", "field") and name in DIRECTIONS | POINTS:
        return SchemaKey(name, "vector", vector or (0.0, 0.0, 0.0), low, high, help_text)
    choices = tuple(part.strip() for part in kind.split("|"))
    if len(choices) > 1 and all(re.fullmatch(r"[a-z-]+", choice) for choice in choices):
        return SchemaKey(name, "choice", default if default in choices else choices[0], low, high, help_text, choices)
    return SchemaKey(name, "other", None, low, high, help_text)


def parse(markdown: str) -> dict[str, SchemaBlock]:
    """All blocks of the manual by their names."""
    blocks = {}
    for section in re.split(r"^## ", markdown, flags=re.MULTILINE)[1:]:
        title, _, body = section.partition("\n")
        paragraphs = [line for line in body.splitlines() if line and not line.startswith(("!", "|", "`", "#"))]
        rows = [ROW.match(line) for line in body.splitlines()]
        keys = tuple(_key(row.group(1), _cells(row.group(2))) for row in rows if row is not None)
        blocks[title.strip()] = SchemaBlock(title.strip(), paragraphs[0] if paragraphs else "", keys)
    return blocks


def operators_of(markdown: str) -> dict[str, SchemaBlock]:
    """The operators that the panel offers, in the order of the manual; each with the keys `mask` and `amount` of all."""
    blocks = parse(markdown)
    row = next((line for line in markdown.splitlines() if line.startswith("| `operators` |")), "")
    common = blocks["operator mask"].keys
    result = {}
    for name in re.findall(r"\[([a-z_]+)\]\(#", row):
        if name in blocks and name not in UNWANTED:
            block = blocks[name]
            own = {key.name for key in block.keys}
            result[name] = SchemaBlock(name, block.help, block.keys + tuple(k for k in common if k.name not in own))
    return result


Answer = tuple[float, "dict[str, SchemaBlock] | PelageFailed"]  # when it came, and what it was


def _ask(program: str) -> dict[str, SchemaBlock] | PelageFailed:
    try:
        result = subprocess.run([program, "manual", "--markdown"], capture_output=True, text=True, timeout=10,
                                stdin=subprocess.DEVNULL)
    except (OSError, ValueError, subprocess.TimeoutExpired) as error:
        return PelageFailed(f"{program} cannot be run: {error}")
    if result.returncode != 0:
        return PelageFailed(f"{program} manual: {result.stderr.strip()}")
    try:
        return operators_of(result.stdout)
    except (KeyError, ValueError) as error:
        return PelageFailed(f"{program} is not a program pelage that this add-on understands: no {error} in its manual")


@functools.lru_cache(maxsize=4)
def _answer(program: str, changed_ns: int) -> Answer:
    result = _ask(program)
    return time.monotonic(), result


def load(program: str) -> dict[str, SchemaBlock]:
    """Operators of the groom of a program; asks it once, and again when the file has changed. Raises PelageFailed."""
    changed_ns = os.stat(program).st_mtime_ns if os.path.exists(program) else 0
    when, result = _answer(program, changed_ns)
    if isinstance(result, PelageFailed) and time.monotonic() - when > FAILURE_S:
        _answer.cache_clear()
        _, result = _answer(program, changed_ns)
    if isinstance(result, PelageFailed):
        raise PelageFailed(str(result))
    return result
