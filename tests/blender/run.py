# SPDX-License-Identifier: Apache-2.0
"""Runs one test of this folder: inside Blender, or beside it. The exit code is 77 where what it needs is not installed."""
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
BESIDE = {"plain", "exit_codes"}  # tests that Blender's Python does not run
SKIPPED = 77


def main():
    name, arguments = sys.argv[1], sys.argv[2:]
    if importlib.util.find_spec("numpy") is None or (name != "plain" and shutil.which("blender") is None):
        return SKIPPED
    path = str(HERE / f"{name}_test.py")
    if name in BESIDE:
        return subprocess.call([sys.executable, "-B", path, *arguments])
    blender = ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P", path, "--", *arguments]
    return subprocess.call(blender, env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})


if __name__ == "__main__":
    sys.exit(main())
