# SPDX-License-Identifier: Apache-2.0
"""Runs `pelage view` and fetches its pictures (docs/VIEW.md, For tools). Knows nothing of Blender."""
from __future__ import annotations

import collections
import http.client
import json
import re
import subprocess
import threading
import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from .process import end, start

ADDRESS = re.compile(r"http://([^:/]+):(\d+)/\?token=(\w+)")
POLL_S = 0.04
TYPES: dict[str, np.dtype] = {"half": np.dtype("<f2"), "float": np.dtype("<f4"), "uint": np.dtype("<u4")}


@dataclass
class ViewPicture:
    """A picture that may still be coarse: one pixel for `grid` x `grid` pixels, from the upper left corner."""
    rgba: np.ndarray  # (rows, columns, 4) float32, the bottom row first
    grid: int
    width: int
    height: int
    version: int
    samples: float


def decode(data: bytes) -> ViewPicture:
    """A layer of four channels as `layer.bin` returns it. Raises ValueError."""
    line, _, body = data.partition(b"\n")
    head = json.loads(line)
    width, height, grid = int(head["width"]), int(head["height"]), max(int(head["grid"]), 1)
    planes, at = [], 0
    for channel in head["channels"]:
        kind = TYPES[channel["type"]]
        planes.append(np.frombuffer(body, kind, width * height, at).reshape(height, width)[::grid, ::grid])
        at += width * height * kind.itemsize
    rgba = np.stack(planes[:4], axis=-1).astype(np.float32)[::-1]
    return ViewPicture(np.ascontiguousarray(rgba), grid, width, height, int(head["version"]), float(head["samples"]))


class ViewClient:
    """A running `pelage view` of a scene file; `picture` is its newest picture."""

    def __init__(self, program: str, scene: str, threads: int = 0) -> None:
        command = [program, "view", scene] + (["--threads", str(threads)] if threads else [])
        self.process = start(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.picture: ViewPicture | None = None
        self.state: dict[str, Any] = {}
        self.error = ""
        self._closing = threading.Event()
        self._last_lines: collections.deque[str] = collections.deque(maxlen=8)  # of standard error
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._listener.start()
        self._thread.start()

    @property
    def ended(self) -> bool:
        """Whether the program has ended, whatever the reason."""
        return self.process.poll() is not None

    def close(self) -> None:
        """Ends the program and the thread."""
        self._closing.set()
        end(self.process)
        for thread in (self._thread, self._listener):
            thread.join(3)
        for pipe in (self.process.stdout, self.process.stderr):
            if pipe is not None:
                pipe.close()

    def _listen(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            if line.strip():
                self._last_lines.append(line.rstrip())

    def _end_message(self) -> str:
        """Why the program has ended: a signal, or its last words."""
        self._listener.join(1)
        try:
            code = self.process.wait(1)
        except subprocess.TimeoutExpired:
            code = 0
        if code > 128:
            return f"pelage view was ended by signal {code - 128}; the next edit starts it again"
        return "\n".join(self._last_lines) or "pelage view has ended; the next edit starts it again"

    def _run(self) -> None:
        assert self.process.stdout is not None
        found = ADDRESS.search(self.process.stdout.readline())
        if found is None:
            if not self._closing.is_set():
                self.error = self._end_message()
            return
        self._host, self._port, self._token = found.group(1), int(found.group(2)), found.group(3)
        while not self._closing.wait(POLL_S):
            try:
                self._poll()
            except (OSError, ValueError, KeyError, http.client.HTTPException) as error:
                if self._closing.is_set():
                    return
                if self.ended:
                    self.error = self._end_message()
                    return
                self.error = f"pelage view does not answer: {error}"
                time.sleep(0.2)

    def _poll(self) -> None:
        state = json.loads(self._get("state.json") or b"{}")
        self.error = str(state.get("error", ""))
        version = state.get("version", 0)
        if version and (self.picture is None or self.picture.version != version):
            data = self._get("layer.bin", "&name=beauty")
            if data:
                self.picture = decode(data)
        self.state = state

    def _get(self, path: str, query: str = "") -> bytes:
        connection = http.client.HTTPConnection(self._host, self._port, timeout=10)
        try:
            connection.request("GET", f"/{path}?token={self._token}{query}")
            answer = connection.getresponse()
            return answer.read() if answer.status == 200 else b""
        finally:
            connection.close()
