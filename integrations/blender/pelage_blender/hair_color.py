# SPDX-License-Identifier: Apache-2.0
"""Absorption of the Principled Hair BSDF, per radius of the fibre, as Cycles computes it from colour or melanin."""
from __future__ import annotations

import math
from collections.abc import Sequence

Color = Sequence[float]


def from_color(color: Color, radial_roughness: float) -> list[float]:
    """Absorption of a fibre for the colour of a dense coat [Chiang16, equation 9]."""
    x = radial_roughness
    fit = 5.969 + x * (-0.215 + x * (2.532 + x * (-10.73 + x * (5.574 + x * 0.245))))
    return [(math.log(min(max(c, 1e-5), 1.0)) / fit) ** 2 for c in color[:3]]


def from_melanin(melanin: float, redness: float, tint: Color, radial_roughness: float) -> list[float]:
    """Absorption of a fraction of melanin from 0 to 1, of which `redness` is pheomelanin, and of a dye of colour `tint`."""
    amount = -math.log(max(1 - melanin, 1e-4))
    eumelanin, pheomelanin = amount * (1 - redness), amount * redness
    dye = from_color(tint, radial_roughness)
    return [eumelanin * e + pheomelanin * p + d
            for e, p, d in zip((0.506, 0.841, 1.653), (0.343, 0.733, 1.924), dye)]
