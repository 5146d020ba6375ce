#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""gather_errors.py PELAGE [FOLDER]: measures the table of errors at every scale in docs/GATHER.md and writes it there.

PELAGE is the program, build/release/bin/pelage; pelage-lab must be beside it. The reports stay in FOLDER, if given.
Needs about 9 CPU minutes. Larger pictures and more samples make the systematic errors more certain."""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "GATHER.md"
MARK = "<!-- tools/gather_errors.py writes this table. -->\n"
SAMPLES, FLICKER_SAMPLES = 64, 16
SIZE = ["image.width=160", "image.height=90"]
SCENES = {
    "rat with a third of its strands, 4 bounces": ("rat", ["grooms.under.strands=70000", "grooms.guard.strands=22000"]),
    "tuft, 3 bounces": ("tuft", []),
    "pale ball, 12 bounces": ("turntable", ["materials.fur={model: chiang, color: [0.85, 0.75, 0.6]}", "render.bounces=12",
                                            "characters.ball.transform=null"]),
}


def measure(pelage, scene, settings, folder):
    """The row of each integrator with SAMPLES, and its flicker."""
    command = [pelage, "measure", "shading", ROOT / "examples" / f"{scene}.yaml", "-o", folder, "--repeat", "1", "--quiet",
               "--parts", "gather", "--samples", f"{FLICKER_SAMPLES},{SAMPLES}", "--flicker-samples", str(FLICKER_SAMPLES),
               "--reference-samples", "64"]
    for setting in SIZE + settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    rows = {row["variant"]: row for row in json.loads((folder / "report.json").read_text())["rows"]}
    return {name: rows[f"{name}, {SAMPLES}"] | {"flicker": rows[f"{name}, {FLICKER_SAMPLES}"]["flicker"]}
            for name in ("path", "gather")}


def percent(value, digits=2, sign=""):
    return "" if value is None else f"{100 * value:{sign}.{digits}f} %".replace("-", "−")


def cells(row):
    blocks = [f"{percent(row[f'systematic_{size}'])} ({percent(row[f'worst_{size}'], 1, '+')})" for size in (8, 32)]
    gains = ["" if row[key] is None else f"{row[key]:.2f}" for key in ("equal_gain", "equal_gain_4", "equal_gain_16")]
    return [f"{row['cpu_s']:.1f}", percent(row["rel_mse"]), percent(row["rel_mse_4"], 3), percent(row["rel_mse_16"], 3),
            percent(row["top_error"], 0), *blocks, percent(row["flicker"]), " / ".join(gains)]


def table(pelage, folder):
    lines = ["| scene | integrator | CPU s | pixels | 4 × 4 | 16 × 16 | 99.9 % | 8 × 8 off (worst) | 32 × 32 off (worst) | flicker | gain |",
             "|" + "---|" * 11]
    for title, (scene, settings) in SCENES.items():
        for name, row in measure(pelage, scene, settings, folder / scene).items():
            lines.append(f"| {title} | `{name}` | " + " | ".join(cells(row)) + " |")
    return "\n".join(lines) + "\n"


def main(pelage, folder):
    new = table(pelage, folder)
    before, after = PAGE.read_text().split(MARK)
    PAGE.write_text(before + MARK + new + "\n" + after.split("\n\n", 1)[1])


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as temporary:
        main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else temporary).resolve())
