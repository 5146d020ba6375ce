# SPDX-License-Identifier: Apache-2.0
"""Runs the program pelage. Blender never loads Pelage: a crash of one does not end the other. Knows nothing of Blender."""
from __future__ import annotations

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from typing import Any

from .scene_json import path_of_line


class PelageFailed(RuntimeError):
    """The program could not be started, or ended with a mistake; the text is for the user."""


class Cancelled(Exception):
    """The user has stopped the render."""


def find_program(wanted: str = "") -> str:
    """Absolute path of the program: the one that is wanted, or else $PELAGE_PROGRAM, or beside this package, or on PATH."""
    beside = pathlib.Path(__file__).parent / "bin" / "pelage"
    for candidate in (wanted,) if wanted else (os.environ.get("PELAGE_PROGRAM", ""), str(beside)):
        if candidate and os.access(candidate, os.X_OK) and os.path.isfile(candidate):
            return os.path.abspath(candidate)
    if wanted:
        raise PelageFailed(f"there is no program {wanted}; please correct the path in the preferences of the add-on")
    found = shutil.which("pelage")
    if found is None:
        raise PelageFailed("the program pelage was not found; please set its path in the preferences of the add-on")
    return os.path.abspath(found)


# The shell asks the program to end when its standard input ends: also when this process is killed. Its exit code is that of the
# program, or 128 + the number of the signal that ended it.
GUARD = ('exec 3<&0; "$@" </dev/null 3<&- & p=$!; { cat <&3 >/dev/null; kill $p 2>/dev/null; } & c=$!; '
         'wait $p; code=$?; kill $c 2>/dev/null; exit $code')


def start(command: list[str], **options: Any) -> subprocess.Popen[str]:
    """Starts a program that ends with this process, in a session of its own, so that Ctrl-C in a terminal does not reach it."""
    return subprocess.Popen(["sh", "-c", GUARD, "sh", *command], stdin=subprocess.PIPE, text=True, encoding="utf-8",
                            errors="replace", start_new_session=True, **options)


def end(process: subprocess.Popen[str], patience_s: float = 3.0) -> None:
    """Ends a program of start(): asks it first, and kills it if it does not end."""
    assert process.stdin is not None
    process.stdin.close()
    try:
        process.wait(patience_s)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _number(value: Any) -> float:
    return float(value) if isinstance(value, (int, float)) else 0.0


class Output(threading.Thread):
    """Reads what a process writes to standard error: one JSON object per line for progress, other lines for mistakes."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        super().__init__(daemon=True)
        self.process, self.stage, self.fraction = process, "", 0.0
        self.mistakes: list[str] = []
        self.warnings: list[str] = []
        self.stages: dict[str, float] = {}
        self.start()

    def run(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            try:
                entry = json.loads(line)
            except ValueError:
                entry = None
            if not isinstance(entry, dict):
                self.mistakes.append(line.rstrip())
            elif "stage" in entry:
                self.stage, self.fraction = str(entry["stage"]), _number(entry.get("done"))
                self.stages[self.stage] = _number(entry.get("elapsed_s"))
            elif "warning" in entry:
                self.warnings.append(str(entry["warning"]))


def readable(line: str, scene: pathlib.Path) -> str:
    """A message of Pelage, with the keys of the value instead of a line of a file that the user never sees."""
    found = re.match(re.escape(str(scene)) + r":(\d+):\d+: (.*)", line)
    if found is None:
        return line
    return f"{path_of_line(scene.read_text(encoding='utf-8'), int(found.group(1)))}: {found.group(2)}"


def run_render(command: list[str], scene: pathlib.Path, stopped: Callable[[], bool],
               progress: Callable[[str, float], None]) -> Output:
    """Runs `pelage render` to its end. Raises Cancelled or PelageFailed; in every case the process has ended."""
    if not os.access(command[0], os.X_OK) and shutil.which(command[0]) is None:
        raise PelageFailed(f"{command[0]} cannot be run")
    process = start(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, cwd=scene.parent)
    output = Output(process)
    try:
        while process.poll() is None:
            if stopped():
                raise Cancelled
            progress(output.stage, output.fraction)
            time.sleep(0.05)
    finally:
        end(process)
        output.join(2)
        if process.stderr is not None:
            process.stderr.close()
    if process.returncode != 0:
        lines = [readable(line, scene) for line in output.mistakes if line]
        number = process.returncode - 128 if process.returncode > 128 else -process.returncode
        crash = f"pelage was ended by signal {number}" if number > 0 else "pelage failed"
        raise PelageFailed("\n".join(lines[:8]) if lines and number <= 0 else crash)
    return output
