# SPDX-License-Identifier: Apache-2.0
"""Renders with more and more samples and plots error over time for two integrators. sweep.py [PICTURE [WIDTH]]"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pelage


def error(picture: pelage.Picture, reference: pelage.Picture) -> float:
    """Relative mean squared error of the colours."""
    a, b = (p.rgba[..., :3].astype(np.float64) for p in (picture, reference))
    return float(np.mean((a - b) ** 2 / (b**2 + 0.01 * b.mean() ** 2)))


def main(picture: str, width: int = 240) -> None:
    small = {"image.width": width, "image.height": width * 9 // 16, "grooms.coat.strands": 8000}
    scene = pelage.open(Path(__file__).parent.parent / "tuft.yaml", set=small)
    scene.set({"render.integrator": "path", "render.samples": 64, "render.seed": 1000})
    reference = scene.render()
    for integrator in ("path", "gather"):
        seconds, errors = [], []
        for samples in (1, 2, 4, 8):
            scene.set({"render.integrator": integrator, "render.samples": samples, "render.seed": samples})
            one = scene.render()
            seconds.append(one.stats["cpu_s"])
            errors.append(error(one, reference))
        plt.loglog(seconds, errors, "o-", label=integrator)
    plt.xlabel("CPU seconds")
    plt.ylabel("relative mean squared error")
    plt.legend()
    plt.savefig(picture)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "sweep.png", *map(int, sys.argv[2:3]))
