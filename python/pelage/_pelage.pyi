# SPDX-License-Identifier: Apache-2.0
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

version: str
compiler: str
libraries: str
lobe_groups: tuple[str, str, str]

class StrandBatch:
    points: NDArray[np.float32]
    radii: NDArray[np.float32]
    offsets: NDArray[np.uint32]
    ids: NDArray[np.uint64]
    root_faces: NDArray[np.uint32] | None
    root_face_uv: NDArray[np.float32] | None
    root_uv: NDArray[np.float32] | None
    attributes: dict[str, NDArray[np.float32]]
    basis: str
    bytes: int
    def __len__(self) -> int: ...
    def write(self, path: str) -> None: ...
    def what_is_lost(self, path: str) -> str: ...

class StrandData: ...

class PoseData: ...

class ImageData:
    name: str

class MeshData:
    name: str
    points: NDArray[np.float32]
    face_sizes: NDArray[np.uint32]
    face_vertices: NDArray[np.uint32]

class PassView:
    samples: int
    mean_samples: float
    grid: int
    coarse: bool
    names: list[str]
    def layers(self, wanted: list[str] | None) -> dict[str, NDArray[Any]]: ...

class Session:
    warnings: list[str]
    names: dict[str, Any]
    def set(self, changes: dict[str, Any]) -> None: ...
    def check(self, changes: dict[str, Any]) -> None: ...
    def cancel(self) -> None: ...
    def grow(self, coat: str, frame: float | None, progress: Callable[[str, float], object] | None) -> StrandBatch: ...
    def render(
        self,
        frame: float | None,
        region: tuple[int, int, int, int] | None,
        output: str,
        progress: Callable[[str, float], object] | None,
        on_pass: Callable[[PassView], object] | None,
    ) -> dict[str, Any]: ...

class Fibre:
    far_field: bool
    def evaluate(
        self, wo: NDArray[np.float32], wi: NDArray[np.float32], h: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]: ...
    def sample(
        self, wo: NDArray[np.float32], h: NDArray[np.float32], u: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]: ...
    def albedo(self, wo: NDArray[np.float32], h: NDArray[np.float32]) -> NDArray[np.float32]: ...

def make_strands(
    points: NDArray[np.float32],
    offsets: NDArray[np.uint32],
    ids: NDArray[np.uint64],
    basis: str,
    attributes: dict[str, NDArray[np.float32]],
) -> StrandBatch: ...
def read_strands(path: str, basis: str, width: float) -> StrandBatch: ...
def share_strands(strands: StrandBatch) -> StrandData: ...
def make_mesh(
    points: NDArray[np.float32],
    face_sizes: NDArray[np.uint32],
    face_vertices: NDArray[np.uint32],
    uv: NDArray[np.float32],
    face_uv: NDArray[np.uint32],
) -> MeshData: ...
def make_poses(points: NDArray[np.float32]) -> PoseData: ...
def make_image(pixels: NDArray[np.float32]) -> ImageData: ...
def make_image8(pixels: NDArray[np.uint8]) -> ImageData: ...
def make_image16(pixels: NDArray[np.uint16]) -> ImageData: ...
def read_mesh(path: str) -> MeshData: ...
def open_scene(path: str, changes: dict[str, Any], threads: int, allow_scripts: bool) -> Session: ...
def make_scene(document: dict[str, Any], changes: dict[str, Any], threads: int, allow_scripts: bool) -> Session: ...
def make_fibre(values: dict[str, Any], progress: Callable[[str, float], object] | None) -> Fibre: ...
def suggest(name: str, names: list[str]) -> str: ...
def schema() -> dict[str, Any]: ...
