# SPDX-License-Identifier: Apache-2.0
"""Which viewport has which session, and when sessions end."""
from __future__ import annotations

import atexit
import threading
import time
import traceback
import weakref
from typing import Any

import bpy

from . import preferences
from .temporary_folders import remove_stale_folders
from .viewport import ViewportSession

KEPT_S = 2.0
"""How long a released session is kept. At each undo, Blender frees the engine of a viewport and makes another one,
which acquires this session."""
_sessions: weakref.WeakSet[ViewportSession] = weakref.WeakSet()
_spare: list[tuple[float, ViewportSession]] = []
_closing = threading.Event()
"""Set when Blender exits. From then on, released sessions end at once."""


def acquire() -> ViewportSession:
    """A session for a new engine: one that has just been released, or a new one. Raises PelageFailed."""
    program = preferences.program()
    while _spare:
        _, session = _spare.pop()
        if session.program == program and (session.client is None or not session.client.ended):
            return session
        _end(session)
    session = ViewportSession()
    _sessions.add(session)
    return session


def release(session: ViewportSession) -> None:
    """Ends a session soon, unless another engine acquires it."""
    if _closing.is_set():
        _end(session)
        return
    _spare.append((time.monotonic(), session))

    def tick() -> float | None:
        for entry in [entry for entry in _spare if time.monotonic() - entry[0] >= KEPT_S]:
            _spare.remove(entry)
            _end(entry[1])
        return 0.5 if _spare else None

    bpy.app.timers.register(tick, first_interval=KEPT_S, persistent=True)


def _end(session: ViewportSession) -> None:
    _sessions.discard(session)
    session.close()


def follow(engine: Any) -> None:
    """Redraws the viewport of an engine whenever there is something new, as long as the engine lives."""
    reference = weakref.ref(engine)

    def tick() -> float | None:
        alive = reference()
        try:
            session = alive.session if alive is not None else None
            if session is None:
                return None
            if session.changed():
                alive.tag_redraw()  # type: ignore[union-attr]
        except ReferenceError:  # Blender has freed the engine
            return None
        except Exception:  # the next picture may be better; without the timer, there would be none
            traceback.print_exc()
            return 1.0
        return 0.05

    bpy.app.timers.register(tick, first_interval=0.05)


def close_all() -> None:
    for session in list(_sessions):
        _end(session)
    _spare.clear()


def _at_exit() -> None:
    _closing.set()
    close_all()


def register() -> None:
    remove_stale_folders()
    atexit.register(_at_exit)


def unregister() -> None:
    close_all()
    atexit.unregister(_at_exit)


CLASSES = ()
