# SPDX-License-Identifier: Apache-2.0
"""Temporary folders, each named after the process that it belongs to. Knows nothing of Blender."""
from __future__ import annotations

import hashlib
import os
import pathlib
import shutil
import socket
import tempfile

PREFIX = "pelage-blender-"
"""How the names of temporary folders begin."""


def owner_prefix() -> str:
    """Returns the prefix of the names of temporary folders that processes of this machine make.

    Several machines may share a folder for temporary files, and each container numbers its processes anew. So the
    prefix names the machine and the container.
    """
    try:
        space = os.readlink("/proc/self/ns/pid")
    except OSError:
        space = ""
    return PREFIX + hashlib.blake2b(f"{socket.gethostname()} {space}".encode(), digest_size=6).hexdigest() + "-"


def new_folder() -> str:
    """A temporary folder whose name says which process it belongs to."""
    return tempfile.mkdtemp(prefix=f"{owner_prefix()}{os.getpid()}-")


def remove_stale_folders() -> None:
    """Removes the folders of processes of this machine that no longer run, because they were killed."""
    prefix = owner_prefix()
    for path in pathlib.Path(tempfile.gettempdir()).glob(f"{prefix}*"):
        owner = path.name[len(prefix):].partition("-")[0]
        if owner.isdigit() and not os.path.exists(f"/proc/{owner}") and os.path.exists("/proc/self"):
            shutil.rmtree(path, ignore_errors=True)
