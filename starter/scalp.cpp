// SPDX-License-Identifier: Apache-2.0
#include "starter/scalp.h"

#include <algorithm>
#include <vector>

#include "starter/cage_faces.h"

namespace pelage {
namespace {

constexpr int kSlices = 40;
constexpr float kNeck = 0.62f;  // a neck is narrower than this fraction of the head
// The hairline in the box of the head, whose height and length are 1: of the nape, and its slope.
constexpr float kNape = 0.04f, kSlope = 0.78f;

}  // namespace

Scalp guess_scalp(const ControlMesh& mesh, const Box3f& box, const V3f& up, const V3f& forward) {
  const V3f side = up.cross(forward);
  const float bottom = std::min(up.dot(box.min), up.dot(box.max));
  const float top = std::max(up.dot(box.min), up.dot(box.max));
  std::vector<float> width(kSlices, 0);
  const auto slice_of = [&](const V3f& p) {
    return std::clamp(static_cast<int>(kSlices * (up.dot(p) - bottom) / (top - bottom)), 0, kSlices - 1);
  };
  const float middle = side.dot(box.center());
  for_each_cage_face(mesh, [&](const CageFace& face) {
    float& widest = width[static_cast<size_t>(slice_of(face.center))];
    widest = std::max(widest, std::abs(side.dot(face.center) - middle));
  });
  int neck = 0;
  float head_width = 0;
  for (int slice = kSlices - 1; slice >= 0 && neck == 0; --slice) {
    const float of_slice = width[static_cast<size_t>(slice)];  // 0: between the rows of a coarse mesh
    if (of_slice > 0 && of_slice < kNeck * head_width) neck = slice + 1;
    head_width = std::max(head_width, of_slice);
  }

  Box3f head;  // x up, y forward
  for_each_cage_face(mesh, [&](const CageFace& face) {
    if (slice_of(face.center) >= neck) head.extendBy(V3f(up.dot(face.center), forward.dot(face.center), 0));
  });
  Scalp scalp;
  const V3f size = head.size();
  if (!(size.y > 0)) return scalp;
  scalp.slope = kSlope * size.x / size.y;
  scalp.height = head.min.x + kNape * size.x - scalp.slope * head.min.y;
  for_each_cage_face(mesh, [&](const CageFace& face) {
    if (up.dot(face.center) > scalp.height + scalp.slope * forward.dot(face.center))
      scalp.area += static_cast<float>(face.area);
  });
  return scalp;
}

}  // namespace pelage
