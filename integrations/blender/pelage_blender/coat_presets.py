# SPDX-License-Identifier: Apache-2.0
"""Coats to start from, in proportion to the mesh. Axes are those of Blender, with the head towards -y. Knows nothing of Blender.

The looks are those of `pelage new` (docs/lab/STARTER.md).
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

Color = tuple[float, float, float]
Operator = tuple[str, dict[str, Any]]


@dataclass(frozen=True)
class Look:
    """Lengths are fractions of the diameter of a ball with the area of the mesh."""
    label: str
    help: str
    length: float
    coverage: float
    strands: int
    lift: float
    droop: float
    bend: float
    waves: float
    clump: float
    clumped: float
    frizz: float
    points: int
    root: Color
    tip: Color
    roughness: float = 0.3
    role: str = "under"


LOOKS = {
    "SHORT": Look("Short", "Sleek and close to the body, like a cow or a horse", 0.045, 6, 350000, 0.25, 0.5, 0, 0.2, 0.03,
                  0.3, 0.03, 5, (0.16, 0.06, 0.025), (0.40, 0.17, 0.07)),
    "LONG": Look("Long", "Long and hanging, like a Highland cow or a Persian cat", 0.24, 12, 200000, 0.3, 0.8, 45, 0.22, 0.06,
                 0.55, 0.03, 10, (0.22, 0.09, 0.03), (0.66, 0.33, 0.12)),
    "FLUFFY": Look("Fluffy", "Dense and soft, of medium length, like a cat or a rabbit", 0.09, 9, 250000, 0.4, 0.45, 15, 0.25,
                   0.045, 0.45, 0.05, 7, (0.13, 0.075, 0.045), (0.52, 0.34, 0.19)),
    "WET": Look("Wet", "Hanging in wet clumps", 0.12, 9, 200000, 0.4, 0.6, 20, 0.2, 0.045, 0.0, 0.03, 10, (0.06, 0.03, 0.015),
                (0.24, 0.13, 0.06), roughness=0.15),
    "WHISKERS": Look("Whiskers", "A few long and stiff strands; mostly in a vertex group", 0.3, 0, 40, 0.6, 0.2, 15, 0, 0, 0, 0,
                     12, (0.5, 0.47, 0.42), (0.85, 0.82, 0.78), role="whisker"),
}


@dataclass
class CoatPlan:
    """What the operator *Add Pelage Fur* sets."""
    strands: int
    points: int
    role: str
    root_color: Color
    tip_color: Color
    roughness: float
    operators: list[Operator] = field(default_factory=list)


def plan(name: str, area: float) -> CoatPlan:
    """The coat of a mesh with this area in square units."""
    look = LOOKS[name]
    size = math.sqrt(max(area, 1e-12) / math.pi)
    length = look.length * size
    result = CoatPlan(look.strands, look.points, look.role, look.root, look.tip, look.roughness)
    add = result.operators.append
    add(("length", {"value": length, "variation": 0.3 if name == "WHISKERS" else 0.4}))
    add(("comb", {"direction": (0.0, 1.0, -look.droop), "lift": look.lift, "curve": 0.4}))
    if look.bend:
        add(("bend", {"direction": (0.0, 0.0, -1.0), "angle": look.bend, "variation": 0.5}))
    if name == "WHISKERS":
        add(("width", {"root": 0.012 * length, "tip": 0.001 * length, "profile": 2.0, "variation": 0.2}))
        return result
    add(("noise", {"amplitude": look.waves * length, "frequency": 2.5 / size}))
    if name == "WET":
        add(("wet", {"spacing": look.clump * size, "gravity": (0.0, 0.0, -1.0), "weight": 40.0, "gather": 0.9, "strays": 0.02}))
    else:
        add(("clump", {"spacing": look.clump * size, "amount": look.clumped, "profile": 0.9, "variation": 0.5, "strays": 0.15}))
        add(("clump", {"spacing": 0.35 * look.clump * size, "amount": look.clumped, "profile": 0.9, "strays": 0.15}))
    add(("curl", {"radius": 0.03 * length, "turns": 0.7, "start": 0.6}))
    add(("frizz", {"amplitude": look.frizz * length, "frequency": 2.0}))
    # Strands taper, vary and differ in length: half of root times length is a strand's mean area. Wider, they are needles.
    width = min(2 * look.coverage * area / (look.strands * length), length / 12)
    add(("width", {"root": width, "tip": 0.2 * width, "profile": 2.5, "variation": 0.3}))
    return result
