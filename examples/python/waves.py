# SPDX-License-Identifier: Apache-2.0
"""An operator in Python: waves run through a coat. waves.py [PICTURE]

The program uses it, too: with

    - python: {module: waves.py, function: waves, bound: 0.25, arguments: {amount: 0.2}}

among the operators of a groom, and the flag --allow-scripts.
"""
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pelage


def waves(strands: Any, amount: float) -> Any:
    phase = 5 * strands.rest_roots[:, :1] + 7 * strands.along  # (n, k), radians
    bend = amount * strands.along * np.sin(phase + strands.random()[:, None])
    strands.points += bend[:, :, None] * strands.frames[:, None, 0]  # along the tangent at each root
    return strands.points


def main(picture: str, width: int) -> None:
    operators = [
        {"length": {"value": 1.2, "variation": 0.2}},
        {"python": {"module": Path(__file__), "function": "waves", "bound": 0.25, "arguments": {"amount": 0.2}}},
        {"clump": {"spacing": 0.25, "amount": 0.5}},
        {"width": {"root": 0.008, "tip": 0.002}},
        {"color": {"value": {"ramp": {"along": "strand", "knots": [[0, [0.1, 0.05, 0.02]], [1, [0.9, 0.6, 0.3]]]}}}},
    ]
    changes = {"grooms.coat.operators": operators, "image.width": width, "image.height": width * 9 // 16,
               "render.samples": 8}
    scene = pelage.open(Path(__file__).parent.parent / "tuft.yaml", set=changes, allow_scripts=True)
    scene.render(output=picture)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "waves.png", int(sys.argv[2]) if len(sys.argv) > 2 else 480)
