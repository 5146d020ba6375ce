# SPDX-License-Identifier: Apache-2.0
"""Runs one test of this folder: inside Blender, or beside it. The exit code is 77 where what it needs is not installed."""
import importlib.util
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
BESIDE = {"plain", "exit_codes", "package"}  # tests that Blender's Python does not run
SKIPPED = 77
PATIENCE_S = 540  # less than the limit of ctest, which ends this program alone
FACTORY = ["--factory-startup", "--python-exit-code", "1"]


def ended(command, environment, **options):
    """Exit code and output of a program; at the time limit, it ends with all that it has started, Xvfb for example."""
    process = subprocess.Popen(command, env=environment, start_new_session=True, **options)
    try:
        output = process.communicate(timeout=PATIENCE_S)[0]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGTERM)
        try:
            output = process.communicate(timeout=10)[0]
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            output = process.communicate()[0]
        print(f"ended after {PATIENCE_S} s")
        return 1, output or ""
    return process.returncode, output


def with_window(path, environment):
    """In a window on a virtual display; afterwards, nothing may be left."""
    blender = ["xvfb-run", "-a", "-s", "-screen 0 320x240x24", "blender", *FACTORY, "-p", "0", "0", "320", "240", "-P", path]
    code, output = ended(blender, environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(output)
    left = re.search(r"folder (\S+) process (\d+)", output)
    passed = code == 0 and "viewport test: passed" in output and left is not None
    return 0 if passed and not os.path.exists(left.group(1)) and not os.path.exists(f"/proc/{left.group(2)}") else 1


def main():
    name, arguments = sys.argv[1], sys.argv[2:]
    needed = [] if name == "plain" else ["blender", "xvfb-run", "xauth"] if name == "viewport" else ["blender"]
    if importlib.util.find_spec("numpy") is None or any(shutil.which(program) is None for program in needed):
        return SKIPPED
    path, environment = str(HERE / f"{name}_test.py"), {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    if name in BESIDE:
        return ended([sys.executable, "-B", path, *arguments], environment)[0]
    if name == "viewport":
        return with_window(path, environment)
    return ended(["blender", "-b", *FACTORY, "-P", path, "--", *arguments], environment)[0]


if __name__ == "__main__":
    sys.exit(main())
