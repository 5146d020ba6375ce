# SPDX-License-Identifier: Apache-2.0
"""Grows a coat and plots how long its strands are, as they are and twice as varied. lengths.py [PICTURE]"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import pelage


def main(picture: str) -> None:
    scene = pelage.open(Path(__file__).parent.parent / "tuft.yaml", set={"grooms.coat.strands": 5000})
    for variation in (0.45, 0.9):
        scene.set("grooms.coat.operators.length.variation", variation)
        hair = scene.grow("coat")
        plt.hist(hair.lengths(), bins=60, alpha=0.6, label=f"variation {variation}: {len(hair)} strands")
    plt.xlabel("length (scene units)")
    plt.ylabel("strands")
    plt.legend()
    plt.savefig(picture)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "lengths.png")
