# SPDX-License-Identifier: Apache-2.0
"""Plots where fibre models send light that arrives at 23 degrees: the last column of the figure "Model, traced light and
both around the fibre" in docs/FIBRES.md. Light arrives from the right. lobes.py [PICTURE [MODEL ...]]"""
import sys

import matplotlib.pyplot as plt
import numpy as np
import pelage
from numpy.typing import NDArray

Curve = NDArray[np.float64]


def around(fibre: pelage.Fibre, phi: Curve) -> Curve:
    """Light that leaves at azimuth phi, summed over inclinations, averaged over the width of the fibre."""
    theta, h = np.linspace(-1.55, 1.55, 63), np.linspace(-0.96, 0.96, 25)
    grid = [g.ravel() for g in np.meshgrid(phi, theta, h, indexing="ij")]
    rho = fibre.evaluate(fibre.direction(np.radians(23), 0), fibre.direction(grid[1], grid[0]), grid[2])[:, 1]
    return np.asarray((rho * np.cos(grid[1])).reshape(len(phi), -1).mean(axis=1), np.float64)


def main(picture: str, models: list[str]) -> None:
    axes = plt.subplot(projection="polar")
    phi = np.linspace(-np.pi, np.pi, 121)
    for model in models:
        light = around(pelage.Fibre(model, color=[0.7, 0.7, 0.7]), phi)
        axes.plot(phi, np.sqrt(light / light.max()), label=model)
    axes.legend()
    plt.savefig(picture)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "lobes.png", sys.argv[2:] or ["kajiya-kay", "marschner", "deon", "chiang"])
