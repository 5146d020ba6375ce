// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <Imath/ImathBox.h>
#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

namespace pelage {

// Vector and matrix types for interfaces and scalar code. They are not trivially copyable, so arrays of
// points and SIMD kernels use plain floats instead.
using Imath::Box3f;
using Imath::M33f;
using Imath::M44f;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

/// Linear, scene-referred colour or radiance with Rec. 709 primaries.
using Rgb = Imath::Color3f;

/// Returns the largest component of a vector or a colour.
inline float max_component(const V3f& v) { return std::max({v.x, v.y, v.z}); }
/// Returns the Rec. 709 luminance of a linear colour.
inline float luminance(const Rgb& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// Right-handed orthonormal frame of a follicle or surface point. The normal points outward. The tangent
/// points along the u direction of the surface. bitangent = normal x tangent.
struct Frame {
  V3f tangent{1, 0, 0};
  V3f bitangent{0, 1, 0};
  V3f normal{0, 0, 1};

  V3f to_world(const V3f& local) const { return local.x * tangent + local.y * bitangent + local.z * normal; }
  V3f to_local(const V3f& world) const {
    return {world.dot(tangent), world.dot(bitangent), world.dot(normal)};
  }
};

}  // namespace pelage
