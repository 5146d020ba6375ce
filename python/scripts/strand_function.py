# SPDX-License-Identifier: Apache-2.0
"""Runs functions for the operator `python`: the part of the module pelage_scripts that is written in Python."""
import difflib
import json
import sys
import types

import numpy


class Batch:
    """Strands that a function of an operator gets; docs/PYTHON.md describes the arrays."""

    __slots__ = ("points", "widths", "roots", "frames", "rest_roots", "rest_frames", "uv", "ids", "attributes", "along",
                 "scale", "_seed")

    def __init__(self, strands, points, color_rows, seed, scale, arrays):
        def array(name, *shape):
            return numpy.frombuffer(arrays[name], numpy.float32).reshape(strands, *shape)

        self.points = array("positions", points, 3).copy()
        self.widths = array("widths", points).copy()
        self.roots = array("roots", 3)
        self.frames = array("frames", 3, 3)
        self.rest_roots = array("rest_roots", 3)
        self.rest_frames = array("rest_frames", 3, 3)
        self.uv = array("uv", 2)
        self.ids = numpy.frombuffer(arrays["ids"], numpy.uint64)
        self.attributes = {"clump": array("clump")}
        if color_rows:
            self.attributes["color"] = array("colors", color_rows, 3).copy()
        self.along = numpy.linspace(0, 1, points, dtype=numpy.float32)
        self.scale = scale
        self._seed = seed

    def __len__(self):
        return len(self.ids)

    def random(self, use=0):
        """Returns (n,), numbers from 0 to below 1 that depend only on the ids, the operator's seed and `use`, a whole number."""
        with numpy.errstate(over="ignore"):
            x = self.ids * numpy.uint64(0x9E3779B97F4A7C15) + numpy.uint64((self._seed + use * 0xD1342543DE82EF95) % 2**64)
            for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB), (31, 1)):
                x = (x ^ (x >> numpy.uint64(shift))) * numpy.uint64(factor)
        return ((x >> numpy.uint64(40)).astype(numpy.float32)) * numpy.float32(2**-24)


class Script:
    """A function of a script with its arguments."""

    def __init__(self, path, source, function, arguments):
        self.path = path
        module = types.ModuleType("pelage_operator")
        module.__file__ = path
        exec(compile(source, path, "exec"), module.__dict__)  # the user has allowed it
        found = getattr(module, function, None)
        if not callable(found):
            names = [name for name, value in vars(module).items() if isinstance(value, types.FunctionType)]
            near = difflib.get_close_matches(function, names, 1)
            raise Refused(f"has no function {function!r}" + (f"; did you mean {near[0]!r}?" if near else ""))
        flush()
        self.function = found
        self.arguments = json.loads(arguments)

    def run(self, strands, points, color_rows, writes_colors, seed, scale, arrays):
        """Calls the function. Returns the bytes of points, widths and colours, each None if not returned."""
        batch = Batch(strands, points, color_rows, seed, scale, arrays)
        result = self.function(batch, **self.arguments)
        flush()
        if isinstance(result, numpy.ndarray):
            result = {"points": result}
        if not isinstance(result, dict):
            raise Refused(f"returned {type(result).__name__}; expected points, or a dict of points, widths and color")
        shapes = {"points": (strands, points, 3), "widths": (strands, points)}
        if writes_colors:
            shapes["color"] = (strands, color_rows, 3)
        for name in result:
            if name == "color" and not writes_colors:
                raise Refused("returned color, but `colors` of the operator is none; expected strand or point")
            if name not in shapes:
                raise Refused(f"returned {name!r}; expected {', '.join(shapes)}")
        return tuple(_bytes(result.get(name), name, shapes.get(name)) for name in ("points", "widths", "color"))


class Refused(Exception):
    """What a function returned, or a script holds, is not what an operator needs."""


def _bytes(value, name, shape):
    if value is None:
        return None
    array = numpy.asarray(value)
    if array.dtype.kind not in "fiu":
        raise Refused(f"returned {name} of {array.dtype}; expected numbers")
    if name == "color" and array.ndim == 2:  # one for each strand
        array = array[:, None, :]
    if name == "widths" and array.shape == (shape[0], 1):
        array = numpy.broadcast_to(array, shape)
    if name == "color" and array.shape == (shape[0], 1, 3):
        array = numpy.broadcast_to(array, shape)
    if array.shape != shape:
        raise Refused(f"returned {name} of the shape {array.shape}; expected {shape}")
    with numpy.errstate(over="ignore"):
        return numpy.ascontiguousarray(array, numpy.float32).tobytes()


def describe(error, path):
    """Returns the line of the script that an exception comes from, 0 if unknown, and one line of text."""
    if isinstance(error, Refused):
        return 0, str(error)
    if isinstance(error, SyntaxError) and error.filename == path:
        return error.lineno or 0, f"{type(error).__name__}: {error.msg}"
    line, trace = 0, error.__traceback__
    while trace:
        if trace.tb_frame.f_code.co_filename == path:
            line = trace.tb_lineno
        trace = trace.tb_next
    text = str(error).strip().splitlines()
    return line, type(error).__name__ + (f": {text[0]}" if text else "")


def flush():
    """What a script prints appears at once, even though the interpreter never ends."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
