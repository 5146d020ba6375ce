// SPDX-License-Identifier: Apache-2.0
#include "world/camera_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr double kMargin = 0.05;  // of the width or height of the picture, on each side

/// A border of the picture: the tangent of the angle between the view axis and the plane through the eye and
/// the border. `bound` is the largest of radius + cosine * offset - sine * depth of all balls: they are on
/// the inner side of the plane if the eye is at most at this bound. `offset`: towards the border.
struct Border {
  double sine, cosine;
  double bound = -std::numeric_limits<double>::infinity();

  explicit Border(double tangent)
      : sine(tangent / std::hypot(1, tangent)), cosine(1 / std::hypot(1, tangent)) {}
  void add(double offset, double depth, double radius) {
    bound = std::max(bound, radius + cosine * offset - sine * depth);
  }
  double offset(double depth) const { return (bound + sine * depth) / cosine; }  // of an eye on the plane
};

/// What a camera sees of balls, along one axis of the picture. `shift`: of the lens, along this axis.
struct SeenExtent {
  Border upper, lower;

  SeenExtent(double tangent, float shift)
      : upper(tangent * (1 - 2 * kMargin + 2 * double(shift))),
        lower(tangent * (1 - 2 * kMargin - 2 * double(shift))) {}
  void add(double offset, double depth, double radius) {
    upper.add(offset, depth, radius);
    lower.add(-offset, depth, radius);
  }
  double depth() const {  // of the nearest eye from which both hold
    return -(upper.bound * lower.cosine + lower.bound * upper.cosine) /
           (upper.sine * lower.cosine + lower.sine * upper.cosine);
  }
  double middle(double depth) const {  // of an eye between both
    return (upper.offset(depth) - lower.offset(depth)) / 2;
  }
};

struct PictureAxes {
  V3d right, up, forward;
};

struct PlacedEye {
  V3d position, target;
  double height = 0;  // of the picture of parallel lines of sight
};

PlacedEye perspective_eye(std::span<const FramedBall> balls, const PictureAxes& axes, double tangent,
                          double aspect, const V2f& shift) {
  SeenExtent wide(tangent * aspect, shift.x), high(tangent, shift.y);
  double near = std::numeric_limits<double>::infinity(), far = -near;
  for (const FramedBall& ball : balls) {
    const V3d at(ball.center);
    const double depth = at.dot(axes.forward), radius = ball.radius;
    wide.add(at.dot(axes.right), depth, radius);
    high.add(at.dot(axes.up), depth, radius);
    near = std::min(near, depth - radius);
    far = std::max(far, depth + radius);
  }
  const double depth = std::min(wide.depth(), high.depth());
  const V3d eye = wide.middle(depth) * axes.right + high.middle(depth) * axes.up + depth * axes.forward;
  return {eye, eye + (0.5 * (near + far) - depth) * axes.forward};
}

PlacedEye parallel_eye(std::span<const FramedBall> balls, const PictureAxes& axes, double aspect,
                       const V2f& shift) {
  Imath::Box3d box;
  for (const FramedBall& ball : balls) {
    const V3d at(ball.center), local(at.dot(axes.right), at.dot(axes.up), at.dot(axes.forward));
    box.extendBy(local - V3d(ball.radius));
    box.extendBy(local + V3d(ball.radius));
  }
  const V3d size = box.size(), middle = box.center();
  const double height = std::max(size.y, size.x / aspect) / (1 - 2 * kMargin);
  const auto world = [&](double depth) {
    return (middle.x - height * aspect * double(shift.x)) * axes.right +
           (middle.y - height * double(shift.y)) * axes.up + depth * axes.forward;
  };
  return {world(box.min.z - size.length()), world(middle.z), height};
}

/// The frames of all keys of animated values; one frame if nothing is animated.
std::set<double> key_frames(const CameraParams& camera) {
  std::set<double> frames;
  const auto add = [&](const auto& values) {
    if (values.is_constant()) return;
    for (const auto& [frame, value] : values.keys()) frames.insert(frame);
  };
  add(camera.position);
  add(camera.look_at);
  add(camera.up);
  if (!camera.is_orthographic()) add(camera.focal_length ? *camera.focal_length : camera.fov);
  if (frames.empty()) frames.insert(0);
  return frames;
}

/// How far strands extend: above the skin at their roots, and the points of strands that a still skin
/// carries.
struct FurExtent {
  float height = 0;
  std::vector<V3f> points;  // rest space
};

/// Measures a few thousand strands of a coat on its skin at rest. Bounds of all strands are much larger than
/// a combed coat: the picture would have wide borders.
void measure_fur(const Groom& groom, const LimitSurface& rest, FurExtent& extent) {
  constexpr size_t kStrands = 3000, kLeaves = 256;
  const auto leaves = groom.follicles().leaves();
  PosedSkin pose;
  pose.keys = {&rest, 1};
  const size_t step = leaves.size() / kLeaves + 1;
  const size_t wanted = std::max<size_t>(8, kStrands * step / std::max<size_t>(1, leaves.size()));
  for (size_t leaf = 0; leaf < leaves.size(); leaf += step) {
    std::vector<uint32_t> some(std::min<size_t>(wanted, leaves[leaf].end - leaves[leaf].begin));
    std::iota(some.begin(), some.end(), 0u);
    const std::vector<float> widths(some.size(), 1.0f);
    const KeptStrands kept{some, widths, {}};
    const Strands strands = groom.grow(leaf, pose, &kept);
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      std::optional<SurfacePoint> root;
      if (groom.grows_on_skin()) root = groom.root(leaves[leaf].begin + s, pose, 0);
      for (size_t i = strands.first_point(s); i < strands.first_point(s + 1); ++i) {
        const V3f point = strands.point(i);
        extent.points.push_back(point);
        if (!root) continue;
        const V3f normal = LimitSurface::frame_of(*root).normal;
        extent.height = std::max(extent.height, (point - root->position).dot(normal) + strands.radius(i));
      }
    }
  }
}

/// The extents of parts on their skins at rest. All members of a crowd share those of their prototype.
using FurExtents = std::map<const PartParams*, FurExtent>;

const FurExtent& fur_extent(const PartParams& part, const Assets& assets, FurExtents& known) {
  const auto [entry, is_new] = known.try_emplace(&part);
  if (!is_new) return entry->second;
  const LimitSurface& rest = *assets.skins.at(part.skin.name).rest;
  FurExtent& extent = entry->second;
  for (const auto& item : part.grooms.items) {
    const Groom& groom = *assets.grooms.at(item.name);
    const bool alone = part.skin.name == kNoSkin;
    if ((groom.grows_on_skin() || alone) && !groom.needs_closest_point()) {
      measure_fur(groom, rest, extent);
    } else {
      extent.height = std::max(extent.height, groom.reach());
    }
  }
  return extent;
}

void add_surface(const LimitSurface& surface, const M44f& to_world, float radius,
                 std::vector<FramedBall>& balls) {
  constexpr double kPoints = 4000;  // on a coarse cage, so that those between the outermost are near to them
  const SurfaceTopology& topology = surface.topology();
  const int steps =
      topology.is_flat() ? 1 : std::clamp(int(std::sqrt(kPoints / topology.face_count())), 2, 32);
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    if (topology.is_hole(face)) continue;
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; j <= (topology.is_triangular() ? steps - i : steps); ++j) {
        const float u = float(i) / float(steps), v = float(j) / float(steps);
        balls.push_back({surface.evaluate(face, u, v).position * to_world, radius});
      }
    }
  }
}

void add_framed_part(const FrameCharacter& character, size_t index, const Assets& assets, double frame,
                     const Job& job, FurExtents& extents, std::vector<FramedBall>& balls) {
  const PartParams& part = character.params->parts[index];
  const Assets::Skin& skin = assets.skins.at(part.skin.name);
  const CharacterPose pose = pose_character(character, index, assets, CameraParams(), frame);
  const FurExtent& fur = fur_extent(part, assets, extents);
  const float radius = fur.height * std::abs(pose.scale) * std::max(1.0f, pose.length);
  if (character.member) {  // one of many: the corners of its box are near enough
    const Box3f box = approximate_box(character, index, assets, frame);
    for (int i = 0; i < 8; ++i)
      balls.push_back(
          {V3f(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z),
           radius});
  } else if (skin.poses || assets.part_poses.contains({character.prototype, index})) {
    const SurfaceTopology::PoseBytes bytes = pose.topology->pose_bytes();
    const MemoryCharge charge =
        reserve(job.ledger, MemoryTag::kSkins, static_cast<int64_t>(bytes.held + bytes.making),
                "the pose of skin " + quote(part.skin.name) + " that the camera frames");
    add_surface(LimitSurface(pose.topology, pose.shutter.cages.front()), M44f(), radius, balls);
  } else {
    const M44f& to_world = pose.shutter.transforms.front();
    add_surface(*skin.rest, to_world, radius, balls);
    for (const V3f& point : fur.points) balls.push_back({point * to_world, 0});
  }
}

std::vector<FramedBall> framed_balls(const SceneDescription& scene, const Assets& assets, const Job& job) {
  const NameReference& wanted = scene.camera.frame;
  std::vector<FramedBall> balls;
  FurExtents extents;
  for (const FrameCharacter& character : frame_characters(scene, assets)) {
    job.check_stop();
    const bool whole = wanted.name == kFrameAll || character.prototype == wanted.name;
    for (size_t part = 0; part < character.params->parts.size(); ++part) {
      if (whole || character.params->parts[part].skin.name == wanted.name)
        add_framed_part(character, part, assets, scene.framed_at, job, extents, balls);
    }
  }
  if (balls.empty())
    throw Error(ErrorKind::kInput, wanted.position,
                "no visible character shows " + quote(wanted.name) + ": the camera has nothing to frame");
  return balls;
}

}  // namespace

CameraParams focused_camera(CameraParams camera, const Assets& assets,
                            std::span<const FrameCharacter> characters, double frame) {
  const std::string& wanted = camera.focus_on.name;
  if (wanted.empty()) return camera;
  const V3f eye = camera.position.at(frame), axis = (camera.look_at.at(frame) - eye).normalized();
  float nearest = std::numeric_limits<float>::infinity();
  bool shown = false;
  for (const FrameCharacter& character : characters) {
    Box3f box;
    for (size_t part = 0; part < character.params->parts.size(); ++part) {
      if (character.prototype == wanted || character.params->parts[part].skin.name == wanted)
        box.extendBy(approximate_box(character, part, assets, frame));
    }
    if (box.isEmpty()) continue;
    shown = true;
    const float depth = (box.center() - eye).dot(axis);
    if (depth > 0) nearest = std::min(nearest, depth);
  }
  if (!std::isfinite(nearest)) {
    throw Error(
        ErrorKind::kInput, camera.focus_on.position,
        shown ? fmt::format("{} is behind the camera at frame {}: nothing to focus on", quote(wanted), frame)
              : "no visible character shows " + quote(wanted) + ": nothing to focus on");
  }
  camera.focus_distance = Keyed<float>(nearest);
  if (camera.lens) camera.lens->focus_distance = nearest;
  return camera;
}

V3f default_view(const V3f& up) {
  const V3f above = up.length() > 0 ? up.normalized() : V3f(0, 1, 0);
  const V3f front = std::abs(above.z) < 0.9f ? V3f(0, 0, 1) : V3f(0, -1, 0);
  const V3f forward = (front - above * above.dot(front)).normalized();
  return 0.75f * forward + 0.6f * above.cross(forward) + 0.25f * above;
}

CameraParams camera_around(std::span<const FramedBall> balls, CameraParams camera, double aspect) {
  std::vector<std::pair<double, V3f>> positions, targets;
  std::vector<std::pair<double, float>> heights;
  for (const double frame : key_frames(camera)) {
    const V3d forward = V3d(camera.look_at.at(frame)) - V3d(camera.position.at(frame));
    const V3d right = forward.cross(V3d(camera.up.at(frame)));
    if (!(right.length() > 1e-6 * forward.length() * V3d(camera.up.at(frame)).length())) return camera;
    PictureAxes axes{right.normalized(), {}, forward.normalized()};
    axes.up = axes.right.cross(axes.forward);
    const double tangent =
        std::tan(camera.fov_at(frame, static_cast<float>(aspect)) * std::numbers::pi / 360);
    const PlacedEye eye = camera.is_orthographic()
                              ? parallel_eye(balls, axes, aspect, camera.shift)
                              : perspective_eye(balls, axes, tangent, aspect, camera.shift);
    positions.emplace_back(frame, V3f(eye.position));
    targets.emplace_back(frame, V3f(eye.target));
    heights.emplace_back(frame, static_cast<float>(eye.height));
  }
  camera.position = Keyed<V3f>(std::move(positions));
  camera.look_at = Keyed<V3f>(std::move(targets));
  if (camera.is_orthographic()) camera.orthographic = Keyed<float>(std::move(heights));
  return camera;
}

CameraParams placed_camera(const SceneDescription& scene, const Assets& assets, const Job& job) {
  if (scene.camera.frame.name.empty()) return scene.camera;
  CameraParams camera = camera_around(framed_balls(scene, assets, job), scene.camera,
                                      double(scene.image.width) / scene.image.height);
  camera.frame = {};
  return camera;
}

}  // namespace pelage
