# SPDX-License-Identifier: Apache-2.0
"""Fibre models."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import _pelage
from ._arguments import callback, whole
from ._arrays import floats
from ._values import scene_value

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    FloatArray = NDArray[np.float32]


class Fibre:
    """Scattering by one fibre that lies along +x, from root to tip.

    Fibre("chiang", roughness=0.3, color=[0.5, 0.3, 0.2]) takes a model and the keys of a material (docs/MANUAL.md);
    Fibre({"model": "chiang", ...}) takes them as a dict. `color` must be constant.

    Directions are unit vectors away from the fibre: `wo` to the viewer, `wi` to the light. An inclination theta is
    measured from the normal plane: x = sin theta. `h`, -1 to 1, is where across the fibre the light arrives. Values
    are rho = f cos theta_i per solid angle, linear RGB: outgoing radiance is the integral of rho times incoming radiance
    over the whole sphere, without a further cosine. `far_field`: whether h should be drawn evenly from -1 to 1.

    Arguments broadcast: wo and wi (n, 3) or (3,), h (n,) or a number.
    """

    def __init__(self, model: str | Mapping[str, Any], *, progress: Any = None, **keys: Any) -> None:
        values = dict(model) if isinstance(model, Mapping) else {"model": model}
        self._fibre: _pelage.Fibre = _pelage.make_fibre(scene_value({**values, **keys}, ""), callback(progress, "progress"))
        self.far_field: bool = self._fibre.far_field

    def evaluate(self, wo: ArrayLike, wi: ArrayLike, h: ArrayLike = 0.0) -> FloatArray:
        """Returns (n, 3), rho of all lobes together."""
        import numpy as np

        lobes, _ = self._fibre.evaluate(*_aligned(wo=wo, wi=wi, h=h))
        return np.asarray(lobes.sum(axis=1), np.float32)

    def lobes(self, wo: ArrayLike, wi: ArrayLike, h: ArrayLike = 0.0) -> dict[str, FloatArray]:
        """Returns rho of each group of lobes, (n, 3): "diffuse", "primary" (R), "secondary" (TRT)."""
        lobes, _ = self._fibre.evaluate(*_aligned(wo=wo, wi=wi, h=h))
        return {name: lobes[:, i] for i, name in enumerate(_pelage.lobe_groups)}

    def pdf(self, wo: ArrayLike, wi: ArrayLike, h: ArrayLike = 0.0) -> FloatArray:
        """Returns (n,), the density per solid angle with which sample() draws wi."""
        return self._fibre.evaluate(*_aligned(wo=wo, wi=wi, h=h))[1]

    def sample(self, wo: ArrayLike, u: ArrayLike, h: ArrayLike = 0.0) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Draws directions. u: (n, 3), random numbers in [0, 1). Returns wi (n, 3), rho (n, 3) and pdf (n,).

        All three are 0 where the fibre scatters nothing.
        """
        outgoing, random, across = _aligned(wo=wo, u=u, h=h)
        if random.size and (random.min() < 0 or random.max() >= 1):
            raise ValueError("u: expected numbers in [0, 1)")
        return self._fibre.sample(outgoing, across, random)

    def albedo(self, wo: ArrayLike, h: ArrayLike = 0.0) -> FloatArray:
        """Returns (n, 3), the integral of rho over all wi as the model states it; approximate for marschner."""
        outgoing, across = _aligned(wo=wo, h=h)
        return self._fibre.albedo(outgoing, across)

    def integrate(self, wo: ArrayLike, h: ArrayLike = 0.0, *, steps: int = 128) -> FloatArray:
        """Returns (n, 3), the integral of rho over all wi by a rule with steps * 2 steps directions. steps: 1 to 4096."""
        import numpy as np

        steps = whole(steps, "steps", 1, 4096)
        outgoing, across = _aligned(wo=wo, h=h)
        x = (np.arange(steps) + 0.5) / steps * 2 - 1  # equal areas: x and the azimuth
        azimuth = (np.arange(2 * steps) + 0.5) / (2 * steps) * 2 * np.pi
        height, angle = (grid.ravel() for grid in np.meshgrid(x, azimuth, indexing="ij"))
        ring = np.sqrt(1 - height**2)
        wi = np.stack([height, ring * np.cos(angle), ring * np.sin(angle)], axis=1)
        rows = [self.evaluate(w, wi, a).mean(axis=0, dtype=np.float64) for w, a in zip(outgoing, across)]
        return np.asarray(np.array(rows).reshape(-1, 3) * 4 * np.pi, np.float32)

    @staticmethod
    def direction(theta: ArrayLike, phi: ArrayLike) -> FloatArray:
        """Returns (n, 3), unit directions with inclination theta and azimuth phi about the fibre, in radians."""
        import numpy as np

        t, p = np.broadcast_arrays(np.atleast_1d(floats(theta, "theta")), np.atleast_1d(floats(phi, "phi")))
        rows = [np.sin(t), np.cos(t) * np.cos(p), np.cos(t) * np.sin(p)]
        return np.asarray(np.stack(rows, axis=-1), np.float32)


def _aligned(**arguments: ArrayLike) -> list[FloatArray]:
    """Checks directions `wo` and `wi`, random numbers `u` and places `h`, and gives them the same number of rows."""
    import numpy as np

    arrays: dict[str, FloatArray] = {}
    for name, value in arguments.items():
        if name == "h":
            array = np.atleast_1d(floats(value, name, (), (None,)))
            if array.size and np.abs(array).max() > 1:
                raise ValueError("h: expected numbers from -1 to 1")
        else:
            array = np.atleast_2d(floats(value, name, (3,), (None, 3)))
            if name != "u" and array.size and np.abs(np.linalg.norm(array, axis=1) - 1).max() > 1e-3:
                raise ValueError(f"{name}: expected unit vectors")
        arrays[name] = array
    sizes = {len(array) for array in arrays.values()} - {1}
    if len(sizes) > 1:
        rows = ", ".join(f"{name} {len(array)}" for name, array in arrays.items())
        raise ValueError(f"the arguments have different numbers of rows: {rows}")
    n = sizes.pop() if sizes else 1
    return [np.ascontiguousarray(np.broadcast_to(a, (n, *a.shape[1:]))) for a in arrays.values()]
