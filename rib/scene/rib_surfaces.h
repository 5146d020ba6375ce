// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "rib/scene/rib_mesh_reader.h"
#include "rib/syntax/rib_basis.h"
#include "rib/syntax/rib_parameters.h"

namespace pelage {

/// Converts the requests Sphere, Cone, Cylinder, Hyperboloid, Paraboloid, Disk and Torus [RISPEC 3.2,
/// Quadrics] to polygons with smooth normals: 48 around the axis, 24 along it. `samples`: the same request at
/// each time of a motion block, or a single one. Throws Error (kInput) for wrong numbers of arguments, and
/// for numbers that are not finite.
RibMesh read_quadric(std::span<RibStatement> samples);

/// Converts the requests Patch, PatchMesh and NuPatch to polygons with smooth normals: 8 along each segment
/// of a bicubic or NURBS surface, 1 along those of a bilinear one. Trim curves are not applied. Throws Error
/// (kInput) for wrong types and counts.
RibMesh read_patches(std::span<RibStatement> samples, const RibDeclarations& declarations, const RibBasis& u,
                     const RibBasis& v);

}  // namespace pelage
