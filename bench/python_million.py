#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times the package for Python: importing it, a million strands to numpy, a view.

PYTHONPATH=build/release/python bench/python_million.py. Growing alone is timed by `pelage grow` on the same scene, in the
same minute, so that the ratio of both matters, not the seconds."""
import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

start = time.process_time()
import pelage  # noqa: E402

print(f"import: {time.process_time() - start:.3f} CPU seconds, peak "
      f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000:.1f} MB")

STRANDS = 1_000_000
SCENE = {
    "pelage": 1,
    "skins": {"skin": {"mesh": "square.obj", "scheme": "none"}},
    "grooms": {"coat": {"skin": "skin", "strands": STRANDS, "points": 8, "operators": [
        {"length": {"value": 0.1}}, {"noise": {"amplitude": 0.01, "frequency": 5}},
        {"clump": {"spacing": 0.01, "amount": 0.5}}, {"frizz": {"amplitude": 0.002, "frequency": 3}},
        {"width": {"root": 0.001}}]}},
    "materials": {"fur": {"model": "chiang"}, "hide": {"model": "lambert"}},
    "characters": {"one": {"parts": [{"skin": "skin", "material": "hide", "grooms": {"coat": "fur"}}]}},
    "render": {"memory": "6G", "lod": {"enabled": False}},
}


def grow_alone(scene):
    """Seconds in which `pelage grow` grows all strands and keeps none."""
    said = subprocess.run([pelage._measure.program(), "grow", scene, "--groom", "coat", "--quiet"],
                          capture_output=True, text=True, check=True).stdout
    return STRANDS / float(re.search(r"(\d+) strands/s", said).group(1))


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "scene.yaml"
        path.write_text(json.dumps(SCENE))
        (path.parent / "square.obj").write_text("v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 4 3 2\n")
        scene = pelage.open(path)
        scene.grow("coat").points  # places the follicles
        ratios = []
        for _ in range(int(sys.argv[1]) if len(sys.argv) > 1 else 3):
            begin = time.perf_counter()
            hair = scene.grow("coat")
            hair.points, hair.radii, hair.offsets, hair.ids
            ratios.append((time.perf_counter() - begin) / grow_alone(path))
        print(f"{len(hair):,} strands to numpy, relative to growing them: {sorted(ratios)[len(ratios) // 2]:.2f}")
        begin = time.perf_counter()
        for _ in range(1000):
            hair.points
        print(f"a view: {(time.perf_counter() - begin) * 1000:.1f} us")


if __name__ == "__main__":
    main()
