# SPDX-License-Identifier: Apache-2.0
"""Exceptions and warnings of the package."""

from __future__ import annotations

import re
from typing import NamedTuple


class Problem(NamedTuple):
    """One mistake and where it is.

    `file` is a file name, or the keys that lead to a value of a scene made in Python ("grooms.coat.strands").
    `line` and `column` count from 1; 0 means unknown.
    """

    file: str
    line: int
    column: int
    message: str

    @property
    def nearest(self) -> str | None:
        """The valid name that is nearest to a misspelt one, or None."""
        found = re.search(r"did you mean '([^']*)'", self.message)
        return found.group(1) if found else None

    def __str__(self) -> str:
        where = self.file
        if self.line > 0:
            where += f":{self.line}" + (f":{self.column}" if self.column > 0 else "")
        return f"{where}: {self.message}" if where else self.message


class Error(ValueError):
    """A mistake in a scene, a file or an argument, or a failure of the system.

    `problems` lists all mistakes; `file`, `line`, `column` and `nearest` describe the first.
    `kind` is "input", "arguments", "memory", "failed" or "stopped". str() has one line per problem.
    """

    def __init__(self, problems: list[tuple[str, int, int, str]], kind: str = "input") -> None:
        self.problems = tuple(Problem(*problem) for problem in problems)
        self.kind = kind
        super().__init__("\n".join(map(str, self.problems)))

    @property
    def file(self) -> str:
        """File, or keys of a scene made in Python; "" if unknown."""
        return self.problems[0].file if self.problems else ""

    @property
    def line(self) -> int:
        """Line, from 1; 0 if unknown."""
        return self.problems[0].line if self.problems else 0

    @property
    def column(self) -> int:
        """Column, from 1; 0 if unknown."""
        return self.problems[0].column if self.problems else 0

    @property
    def nearest(self) -> str | None:
        """The valid name that is nearest to the misspelt one, or None."""
        return next((p.nearest for p in self.problems if p.nearest), None)

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), ([tuple(p) for p in self.problems], self.kind)


class Cancelled(Error):
    """The work was cancelled by Scene.cancel() before there was a result."""


class PelageWarning(UserWarning):
    """Something that does not stop the work but that the user should know."""
