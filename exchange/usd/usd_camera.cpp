// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "exchange/usd/usd_shading.h"

namespace pelage {
namespace {

/// The values of a camera at a time. Lengths are in tenths of a scene unit, as USD has them, but the focus.
struct UsdCameraValues {
  M44f to_world;
  float focal_length, width, height, focus, exposure;
};

/// A camera without a lens has no size: any focal length gives the same picture.
constexpr float kAnyFocalLength = 50;

/// Nothing of a scene is nearer or farther, in metres. Without a range, USD has 1 to 1,000,000 units.
constexpr double kNearest = 0.001, kFarthest = 10'000;

UsdCameraValues values_at(const UsdCamera& camera, const CameraParams& params, double time) {
  const float aspect = static_cast<float>(camera.width) / static_cast<float>(camera.height);
  const Camera at(params, time, camera.width, camera.height);
  // Camera space of the matrix looks along +z, that of USD along -z.
  const M44f mirror(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
  UsdCameraValues v;
  v.to_world = (at.world_to_camera() * mirror).inverse();
  const std::optional<LensParams> lens = params.lens_at(time, aspect);
  v.focal_length = lens ? 10 * lens->focal_length : kAnyFocalLength;
  v.focus = lens ? lens->focus_distance : 0;
  v.height = params.is_orthographic()
                 ? 10 * params.height_at(time, aspect)
                 : 2 * v.focal_length *
                       std::tan(0.5f * params.fov_at(time, aspect) * (std::numbers::pi_v<float> / 180));
  v.width = v.height * aspect;
  v.exposure = params.exposure.at(time);
  return v;
}

std::string text_of(const M44f& m) {
  std::string text = "( ";
  for (int row = 0; row < 4; ++row) {
    text +=
        fmt::format("{}({}, {}, {}, {})", row == 0 ? "" : ", ", m[row][0], m[row][1], m[row][2], m[row][3]);
  }
  return text + " )";
}

class CameraPrim {
 public:
  CameraPrim(UsdWriter& usd, const UsdCamera& camera) : usd_(usd) {
    for (size_t i = 0; i < camera.frames.size(); ++i) {
      const V2f shutter = camera.params[i].shutter;
      std::vector<double> times{double(camera.frames[i])};
      if (shutter.y > shutter.x)
        times = {camera.frames[i] + double{shutter.x}, camera.frames[i] + double{shutter.y}};
      for (const double time : times) {
        if (!samples_.empty() && time <= samples_.back().first) continue;
        samples_.emplace_back(time, values_at(camera, camera.params[i], time));
      }
    }
  }

  /// Writes a value, with time samples if it is not always the same.
  template <class Text>
  void write(const std::string& declaration, const Text& text) {
    const std::string first = text(samples_[0].second);
    bool moves = false;
    for (const auto& [time, values] : samples_) moves |= text(values) != first;
    if (!moves) return usd_.line(declaration + " = " + first);
    usd_.open_samples(declaration);
    for (const auto& [time, values] : samples_) usd_.line(fmt::format("{}: {},", time, text(values)));
    usd_.close();
  }
  void number(const std::string& declaration, float UsdCameraValues::*member) {
    write(declaration, [&](const UsdCameraValues& v) { return fmt::format("{}", v.*member); });
  }

 private:
  UsdWriter& usd_;
  std::vector<std::pair<double, UsdCameraValues>> samples_;
};

}  // namespace

void write_usd_camera(UsdWriter& usd, const std::string& name, const UsdCamera& camera) {
  const CameraParams& params = camera.params.front();
  const float aspect = static_cast<float>(camera.width) / static_cast<float>(camera.height);
  usd.open(fmt::format("def Camera {}", usd_string(name)));
  CameraPrim prim(usd, camera);
  usd.line(
      fmt::format("token projection = \"{}\"", params.is_orthographic() ? "orthographic" : "perspective"));
  usd.line(fmt::format("float2 clippingRange = ({}, {})",
                       static_cast<float>(kNearest / camera.meters_per_unit),
                       static_cast<float>(kFarthest / camera.meters_per_unit)));
  prim.number("float focalLength", &UsdCameraValues::focal_length);
  prim.number("float horizontalAperture", &UsdCameraValues::width);
  prim.number("float verticalAperture", &UsdCameraValues::height);
  prim.write("float horizontalApertureOffset",
             [&](const UsdCameraValues& v) { return fmt::format("{}", v.width * params.shift.x); });
  prim.write("float verticalApertureOffset",
             [&](const UsdCameraValues& v) { return fmt::format("{}", v.height * params.shift.y); });
  const std::optional<LensParams> lens = params.lens_at(camera.frames[0], aspect);
  usd.line(fmt::format("float fStop = {}", lens ? lens->f_stop : 0.0f));
  if (lens) prim.number("float focusDistance", &UsdCameraValues::focus);
  prim.number("float exposure", &UsdCameraValues::exposure);
  usd.line(fmt::format("double shutter:open = {}", params.shutter.x));
  usd.line(fmt::format("double shutter:close = {}", params.shutter.y));
  prim.write("matrix4d xformOp:transform", [](const UsdCameraValues& v) { return text_of(v.to_world); });
  usd.line("uniform token[] xformOpOrder = [\"xformOp:transform\"]");
  usd.close();
}

}  // namespace pelage
