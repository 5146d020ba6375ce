# SPDX-License-Identifier: Apache-2.0
"""Renders for a notebook: shows the picture while it forms, then its layers side by side. layers.py [PICTURE [WIDTH]]"""
import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pelage
from numpy.typing import NDArray


def for_screen(layer: NDArray[Any]) -> NDArray[np.float32]:
    """Any layer as colours from 0 to 1: directions and numbers are spread over their range."""
    shown = layer[..., :3].astype(np.float32)
    if layer.shape[-1] == 2:
        shown = np.concatenate([shown, np.zeros_like(shown[..., :1])], axis=-1)
    low, high = np.percentile(shown[np.isfinite(shown)], [1, 99])
    return np.asarray(np.clip((shown - low) / max(high - low, 1e-9), 0, 1), np.float32)


def main(picture: str, width: int = 240) -> None:
    small = {"image.width": width, "image.height": width * 9 // 16, "render.samples": 8, "grooms.coat.strands": 8000}
    scene = pelage.open(Path(__file__).parent.parent / "tuft.yaml", set=small)
    frame = scene.render(on_pass=lambda p: print(f"{p.samples} samples, mean {p['RGBA'].mean():.3f}"))
    names = [name for name in frame if name not in ("id", "id.X")]
    for place, name in enumerate(names, 1):
        axes = plt.subplot(4, (len(names) + 3) // 4, place)
        axes.imshow(frame.display() if name == "RGBA" else for_screen(frame[name]))
        axes.set_title(name, fontsize=6)
        axes.axis("off")
    plt.savefig(picture, dpi=150)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "layers.png", *map(int, sys.argv[2:3]))
