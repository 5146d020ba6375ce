// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "post/stereo_file.h"

namespace pelage {
namespace {

const M44f* matrix(const ExrPart& part, const char* name) {
  const auto found = part.attributes.find(name);
  return found == part.attributes.end() ? nullptr : std::get_if<M44f>(&found->second);
}

/// From camera space to NDC; empty when the header does not contain it.
std::optional<Imath::M44d> projection(const ExrPart& part) {
  const M44f* camera = matrix(part, "worldToCamera");
  const M44f* ndc = matrix(part, "worldToNDC");
  if (!camera || !ndc) return {};
  const Imath::M44d to_camera(*camera);
  if (!(std::abs(to_camera.determinant()) > 1e-30)) return {};
  return to_camera.inverse() * Imath::M44d(*ndc);
}

}  // namespace

std::optional<float> focal_pixels_of(const ExrPart& part) {
  const auto p = projection(part);
  if (!p) return {};
  // A point moved by 1 perpendicular to the axis at depth 1 moves by this fraction of the width.
  const double focal = std::abs((*p)[0][0] / (*p)[2][3]) * part.display.width();
  if (!std::isfinite(focal) || focal <= 0) return {};
  return static_cast<float>(focal);
}

void move_camera(ExrPart& part, const StereoCamera& camera) {
  const auto p = projection(part);
  if (!p || camera.focal_pixels <= 0) return;
  Imath::M44d step;
  step.setTranslation(Imath::V3d(-camera.eye_separation, 0, 0));
  const Imath::M44d to_camera = Imath::M44d(*matrix(part, "worldToCamera")) * step;
  // The picture is shifted so that points at the convergence distance do not move.
  Imath::M44d shifted = *p;
  const double shift = static_cast<double>(camera.focal_pixels) * camera.eye_separation / camera.convergence /
                       part.display.width();
  for (int row = 0; row < 4; ++row) shifted[row][0] += shift * shifted[row][3];
  part.attributes["worldToCamera"] = M44f(to_camera);
  part.attributes["worldToNDC"] = M44f(to_camera * shifted);
}

}  // namespace pelage
