# SPDX-License-Identifier: Apache-2.0
"""Experiments of the program `pelage`."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import Any

from ._arguments import mapping, text
from ._arguments import path as file_path
from ._errors import Error
from ._values import changes

_KINDS = {2: "arguments", 3: "input", 4: "memory", 130: "stopped", 143: "stopped", 129: "stopped"}
"""Kinds of errors by exit code (docs/RUNNING.md)."""


def program() -> str:
    """Returns the program `pelage` of this installation: PELAGE_PROGRAM, the one beside the package, or on PATH."""
    import pathlib
    import shutil

    named = os.environ.get("PELAGE_PROGRAM")
    if named:
        return named
    # In PREFIX/lib/.../pelage, or in python/pelage of a build folder. No other folder above is searched: a stranger
    # may have put a program there.
    parents = pathlib.Path(__file__).resolve().parents
    prefix = next((p.parent for p in parents if p.name == "lib"), None)
    if parents[1].name == "python":
        prefix = parents[2]
    beside = prefix / "bin" / "pelage" if prefix else None
    if beside and beside.is_file():
        return str(beside)
    found = shutil.which("pelage")
    if found is None:
        raise FileNotFoundError("the program 'pelage' is neither beside the package nor on PATH; set PELAGE_PROGRAM")
    return found


def measure(
    experiment: str, scene: str | os.PathLike[str], *, set: Mapping[str, Any] | None = None, **options: Any
) -> dict[str, Any]:
    """Runs `pelage measure EXPERIMENT SCENE` and returns its report.json as a dict.

    experiment: "bounds", "lod", "shading" and others (docs/MEASURE.md). set: values of the scene, by key; numbers, text
    and lists of them. options: flags of the command, `time_limit=60` for --time-limit 60; lists are joined by commas.
    Raises pelage.Error, with the problems that the command states, if it fails.
    """
    import json
    import subprocess
    import tempfile

    what = [text(experiment, "experiment"), file_path(scene, "scene")]
    values = changes(mapping(set, "set"))
    with tempfile.TemporaryDirectory(prefix="pelage-") as folder:
        command = [program(), "measure", *what, "-o", folder, "--quiet"]
        for key, value in values.items():
            command += ["--set", f"{key}={_yaml(value)}"]
        for name, value in options.items():
            argument = ",".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)
            command += ["--" + name.replace("_", "-"), argument]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise _error(done.returncode, done.stderr)
        with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
            report: dict[str, Any] = json.load(file)
        return report


def _error(code: int, said: str) -> Error:
    """Returns the error that a command has printed, one problem per line: "file:line:column: message"."""
    lines = [line for line in said.splitlines() if line.strip()] or [f"pelage measure ended with exit code {code}"]
    problems: list[tuple[str, int, int, str]] = []
    for line in lines:
        found = re.match(r"(?P<file>[^:]+)(?::(?P<line>\d+))?(?::(?P<column>\d+))?: (?P<message>.*)", line)
        if found and found["file"] not in ("pelage", "pelage: error"):
            place = (found["file"], int(found["line"] or 0), int(found["column"] or 0))
            problems.append((*place, found["message"]))
        else:
            problems.append(("", 0, 0, line.removeprefix("pelage: error: ")))
    return Error(problems, _KINDS.get(code, "failed"))


def _yaml(value: Any) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(_yaml, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_yaml(item)}" for key, item in value.items()) + "}"
    return "null" if value is None else str(value)
