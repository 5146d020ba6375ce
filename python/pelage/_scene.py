# SPDX-License-Identifier: Apache-2.0
"""Scenes."""

from __future__ import annotations

import operator
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional

from . import _pelage
from ._arguments import callback, flag, mapping, number, text, whole
from ._arguments import path as file_path
from ._errors import PelageWarning
from ._picture import Pass, Picture
from ._strands import Strands
from ._values import changes, scene_value

Progress = Optional[Callable[[str, float], object]]
"""progress(stage, fraction): called about every 50 ms on the thread that called; an exception stops the work."""


class Scene:
    """A scene whose values change, whose coats grow, whose frames are rendered, any number of times.

    Scene(values) makes a scene from a dict with the keys of a scene file (`pelage.schema()`, docs/MANUAL.md). A value
    is a number, text, a list, a dict, a numpy array, a Mesh or Poses in place of OBJ files, or Strands in place of a
    strand file. `pelage: 1`, the version of the format, need not be given. Relative names of files start at the current
    folder. `pelage.open(path)` reads a file.

    threads: number of threads; 0 means all processors. The pixels do not depend on it.
    allow_scripts: whether operators `python` may run the functions that the scene names. They may do whatever you may do,
        so pass True only for scenes that you trust.

    Several threads may use one scene: their renders take turns. Two scenes render at the same time. All methods raise
    pelage.Error, with file, line, column and nearest name; TypeError and ValueError name the key of a bad value.
    """

    def __init__(self, values: Mapping[str, Any], *, threads: int = 0, allow_scripts: bool = False) -> None:
        if not isinstance(values, Mapping):
            raise TypeError(f"values: expected a dict, got {type(values).__name__}")
        document = scene_value({"pelage": 1, **values}, "")
        self._take(_pelage.make_scene(document, {}, whole(threads, "threads", 0, 4096), flag(allow_scripts, "allow_scripts")))

    def _take(self, session: _pelage.Session) -> None:
        self._session = session
        self._warned: set[str] = set()
        self._warn()

    @staticmethod
    def _open(path: str, set: Mapping[str, Any] | None, threads: int, allow_scripts: bool) -> Scene:
        scene = Scene.__new__(Scene)
        scene._take(_pelage.open_scene(path, changes(mapping(set, "set")), threads, flag(allow_scripts, "allow_scripts")))
        return scene

    def _warn(self) -> None:
        for line in self._session.warnings:
            if line not in self._warned:
                self._warned.add(line)
                warnings.warn(line, PelageWarning, stacklevel=4)

    def set(self, key: str | Mapping[str, Any], value: Any = None) -> None:
        """Sets one value, or all values of a dict: all of them or none.

        key: path to the value, such as "grooms.coat.operators.clump.amount". The path names an item of a list by its
        index or its key. None removes a value, which then has its default. Raises pelage.Error and changes nothing if
        the scene would not be valid.
        """
        self._session.set(changes(key, value))
        self._warn()

    def validate(self, key: str | Mapping[str, Any] | None = None, value: Any = None) -> list[str]:
        """Returns the mistakes that set() would raise for these values, one line each; does not change the scene."""
        from ._errors import Error

        if key is None:
            return []
        try:
            self._session.check(changes(key, value))
        except Error as error:
            return [str(problem) for problem in error.problems]
        return []

    def grow(self, coat: str, *, frame: float | None = None, progress: Progress = None) -> Strands:
        """Grows a coat and returns its strands, ordered by id, in world space and without level of detail.

        coat: the name of a groom ("coat": on all characters), or of a coat of one character ("rat.coat").
        frame: number of the frame; None means the first of the scene.
        """
        return Strands._of(self._session.grow(text(coat, "coat"), _frame(frame), callback(progress, "progress")))

    def render(
        self,
        frame: float | None = None,
        *,
        region: Sequence[int] | None = None,
        output: str | os.PathLike[str] | None = None,
        progress: Progress = None,
        on_pass: Callable[[Pass], object] | None = None,
    ) -> Picture:
        """Renders a frame and returns its layers as arrays. Ctrl-C stops it with KeyboardInterrupt.

        frame: number of the frame; None means the first of the scene.
        region: the only pixels to render, (x0, y0, x1, y1).
        output: file to write as well: .exr with all layers, .png or .jpg. Not written if the picture is partial.
        progress: see Progress. on_pass: called between passes with a Pass, on another thread than the caller's.
        cancel() ends the render with a partial picture, or with pelage.Cancelled if there are no samples yet.
        """
        box = None if region is None else _region(region, self.size)
        shown = callback(on_pass, "on_pass")
        watch = None if shown is None else (lambda view: shown(Pass(view)))
        file = "" if output is None else file_path(output, "output")
        return Picture(self._session.render(_frame(frame), box, file, callback(progress, "progress"), watch))

    def cancel(self) -> None:
        """Cancels what other threads are doing with this scene; no effect on later calls."""
        self._session.cancel()

    @property
    def grooms(self) -> list[str]:
        """Names of the grooms."""
        return self._names("grooms")

    @property
    def characters(self) -> list[str]:
        """Names of the characters."""
        return self._names("characters")

    @property
    def materials(self) -> list[str]:
        """Names of the materials."""
        return self._names("materials")

    @property
    def lights(self) -> list[str]:
        """Names of the lights."""
        return self._names("lights")

    @property
    def frames(self) -> list[int]:
        """Numbers of the frames."""
        frames: list[int] = self._session.names["frames"]
        return frames

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture, in pixels."""
        size: tuple[int, int] = self._session.names["size"]
        return size

    def _names(self, kind: str) -> list[str]:
        names: list[str] = self._session.names[kind]
        return names

    def __repr__(self) -> str:
        return f"<pelage.Scene: grooms {', '.join(self.grooms) or 'none'}; {self.size[0]} x {self.size[1]}>"


def open(
    path: str | os.PathLike[str], *, set: Mapping[str, Any] | None = None, threads: int = 0, allow_scripts: bool = False
) -> Scene:
    """Opens a scene file.

    set: values that replace values of the file, by key. threads: number of threads; 0 means all processors.
    allow_scripts: see Scene.
    Raises pelage.Error with all mistakes of the file, each with line and column.
    """
    return Scene._open(file_path(path, "path"), set, whole(threads, "threads", 0, 4096), allow_scripts)


def _frame(frame: Any) -> float | None:
    return None if frame is None else number(frame, "frame", 1e6)


def _region(region: Any, size: tuple[int, int]) -> tuple[int, int, int, int]:
    try:
        x0, y0, x1, y1 = map(operator.index, region)
    except TypeError:
        raise TypeError("region: expected four integers x0, y0, x1, y1") from None
    except ValueError:
        raise ValueError("region: expected four integers x0, y0, x1, y1") from None
    if not (0 <= x0 < x1 <= size[0] and 0 <= y0 < y1 <= size[1]):
        raise ValueError(f"region: expected a box inside {size[0]} x {size[1]} pixels, got {(x0, y0, x1, y1)}")
    return x0, y0, x1, y1


__all__ = ["Progress", "Scene", "open"]
