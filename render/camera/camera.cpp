// SPDX-License-Identifier: Apache-2.0
#include "render/camera/camera.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "render/sampling/warp.h"

namespace pelage {

bool CameraParams::is_orthographic() const {
  return orthographic || projection == CameraProjection::kOrthographic;
}

float CameraParams::fov_at(double time, float aspect) const {
  if (!focal_length) return fov.at(time);
  return std::atan(sensor / (2 * aspect * focal_length->at(time))) * 360 / kPi;
}

float CameraParams::height_at(double time, float aspect) const {
  if (orthographic) return orthographic->at(time);
  const float distance = (look_at.at(time) - position.at(time)).length();
  return 2 * distance * std::tan(fov_at(time, aspect) * kPi / 360);
}

std::optional<LensParams> CameraParams::lens_at(double time, float aspect) const {
  if (is_orthographic()) return {};
  if (!f_stop) return lens;
  const float sensor_height = sensor / aspect;
  const float focal_mm =
      focal_length ? focal_length->at(time) : sensor_height / (2 * std::tan(fov.at(time) * kPi / 360));
  const float distance =
      focus_distance ? focus_distance->at(time) : (look_at.at(time) - position.at(time)).length();
  return LensParams{*f_stop, focal_mm * 0.001f / meters_per_unit, distance};
}

Camera::Pose Camera::make_pose(const CameraParams& params, double frame, float aspect, const V3f& origin) {
  Pose pose;
  pose.position = relative_to(params.position, origin).at(frame);
  const V3f view = relative_to(params.look_at, origin).at(frame) - pose.position;
  const V3f right = view.cross(params.up.at(frame));
  if (view.length() == 0) {
    throw Error(ErrorKind::kInput,
                fmt::format("camera: position and look_at are the same point at frame {}", frame));
  }
  if (right.length() <= 1e-6f * view.length() * params.up.at(frame).length()) {
    throw Error(ErrorKind::kInput,
                fmt::format("camera: the view direction is parallel to the up vector at frame {}", frame));
  }
  pose.forward = view.normalized();
  pose.right = right.normalized();
  pose.up = pose.right.cross(pose.forward);
  pose.half_height = params.is_orthographic() ? 0.5f * params.height_at(frame, aspect)
                                              : std::tan(params.fov_at(frame, aspect) * kPi / 360);
  return pose;
}

Camera::Pose Camera::blend(const Pose& a, const Pose& b, float t) {
  Pose pose;
  pose.position = a.position * (1 - t) + b.position * t;
  pose.forward = (a.forward * (1 - t) + b.forward * t).normalized();
  pose.right = pose.forward.cross(a.up * (1 - t) + b.up * t).normalized();
  pose.up = pose.right.cross(pose.forward);
  pose.half_height = a.half_height * (1 - t) + b.half_height * t;
  return pose;
}

Camera::Camera(const CameraParams& params, double frame, int width, int height, const V3f& origin)
    : origin_(origin),
      shutter_(params.shutter),
      shift_(params.shift),
      shutter_curve_(params.shutter_curve),
      width_(width),
      height_(height),
      parallel_(params.is_orthographic()) {
  frame_ = make_pose(params, frame, aspect(), origin);
  next_frame_ = make_pose(params, frame + 1, aspect(), origin);
  const Keyed<float>& zoom = params.orthographic   ? *params.orthographic
                             : params.focal_length ? *params.focal_length
                                                   : params.fov;
  const bool still = params.position.is_constant() && params.look_at.is_constant() &&
                     params.up.is_constant() && zoom.is_constant();
  const int count = still || shutter_frames() <= 0 ? 1 : std::max(params.motion_keys, 2);
  for (int k = 0; k < count; ++k) {
    const double at = count == 1 ? shutter_.x : shutter_.x + shutter_frames() * k / (count - 1.0);
    keys_.push_back(make_pose(params, frame + at, aspect(), origin));
  }
  if (const std::optional<LensParams> lens = params.lens_at(frame, aspect())) {
    lens_radius_ = lens->focal_length / (2 * lens->f_stop);
    focus_distance_ = lens->focus_distance;
  }
}

Camera::Pose Camera::pose_at(float time) const {
  if (keys_.size() == 1) return keys_.front();
  const float scaled = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(keys_.size() - 1);
  const size_t key = std::min(static_cast<size_t>(scaled), keys_.size() - 2);
  return blend(keys_[key], keys_[key + 1], scaled - static_cast<float>(key));
}

CameraRay Camera::ray(float x, float y, const V2f& lens, float time) const {
  const Pose pose = pose_at(time);
  const float scale = 2 * pose.half_height / static_cast<float>(height_);
  const float sx = (x - axis_x()) * scale;
  const float sy = (axis_y() - y) * scale;
  if (parallel_) return {pose.position + sx * pose.right + sy * pose.up, pose.forward, time};
  const V3f through = pose.forward + sx * pose.right + sy * pose.up;  // unit length along the axis
  if (lens_radius_ == 0) return {pose.position, through.normalized(), time};
  const V2f disk = lens_radius_ * concentric_disk(lens);
  const V3f origin = pose.position + disk.x * pose.right + disk.y * pose.up;
  return {origin, (pose.position + focus_distance_ * through - origin).normalized(), time};
}

std::optional<V3f> Camera::project(const Pose& pose, const V3f& world) const {
  const V3f local = world - pose.position;
  const float depth = local.dot(pose.forward);
  if (!(depth > 0)) return std::nullopt;
  const float scale = pixels_at(pose, depth);
  return V3f(axis_x() + scale * local.dot(pose.right), axis_y() - scale * local.dot(pose.up), depth);
}

V2f Camera::picture_position(const V3f& origin, const V3f& direction, float time) const {
  const Pose pose = pose_at(time);
  const float depth = has_lens() ? focus_distance_ : 1;  // where all rays of a raster position meet
  const V3f local = origin - pose.position + direction * (depth / direction.dot(pose.forward));
  const float scale = pixels_at(pose, depth);
  return V2f((axis_x() + scale * local.dot(pose.right)) / static_cast<float>(width_),
             (axis_y() - scale * local.dot(pose.up)) / static_cast<float>(height_));
}

float Camera::projected_length(std::span<const float> points, float time) const {
  const Pose pose = pose_at(time);
  V2f from(0);
  bool from_visible = false;
  float length = 0;
  for (size_t i = 0; i + 3 < points.size(); i += 4) {
    const V3f local = V3f(points[i], points[i + 1], points[i + 2]) - pose.position;
    const float depth = local.dot(pose.forward);
    const bool visible = depth > 0;
    const float scale = pixels_at(pose, depth);
    const V2f to(scale * local.dot(pose.right), scale * local.dot(pose.up));
    if (visible && from_visible) length += std::sqrt((to - from).dot(to - from));
    from = to;
    from_visible = visible;
  }
  return length;
}

bool Camera::may_see(const Box3f& box) const {
  if (box.isEmpty()) return false;
  const float aspect = this->aspect();
  // Number of corners outside of each half space, over all keys: behind, left, right, below, above. A box
  // that is beyond a border at every key is beyond it between the keys too. Seen from a point a of the lens,
  // a border is shifted sideways by a (1 - depth / focus). The distance by which a point is beyond a border
  // for the whole lens is a concave function of the point, so a box is beyond the border when all its corners
  // are.
  size_t outside[5] = {};
  for (const Pose& pose : keys_) {
    for (int corner = 0; corner < 8; ++corner) {
      const V3f at(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                   corner & 4 ? box.max.z : box.min.z);
      const V3f local = at - pose.position;
      const float depth = local.dot(pose.forward), x = local.dot(pose.right), y = local.dot(pose.up);
      const float blur = has_lens() ? lens_radius_ * std::abs(1 - depth / focus_distance_) : 0;
      const float half = (parallel_ ? 1 : depth) * pose.half_height;
      const float right = 2 * shift_.x * half * aspect, up = 2 * shift_.y * half;  // of the centre
      const float half_height = half + blur, half_width = half * aspect + blur;
      outside[0] += depth <= 0;
      outside[1] += x < right - half_width;
      outside[2] += x > right + half_width;
      outside[3] += y < up - half_height;
      outside[4] += y > up + half_height;
    }
  }
  return *std::max_element(outside, outside + 5) < 8 * keys_.size();
}

namespace {

// An orthographic camera sees the same size at any distance: all distances count as this one.
constexpr float kAnyDistance = 1e12f;

}  // namespace

View Camera::view() const {
  View view;
  view.position = frame_.position;
  if (parallel_) view.near_distance = kAnyDistance;
  view.focal_pixels = pixels_at(frame_, 1) * (parallel_ ? kAnyDistance : 1);
  return view;
}

LodView Camera::lod_view() const {
  const auto pose = [this](float time) {
    const Pose at = pose_at(time);
    return LodPose{at.position, at.right, at.up, at.forward,
                   pixels_at(at, 1) * (parallel_ ? kAnyDistance : 1)};
  };
  LodView view{pose(0), pose(1)};
  if (parallel_) view.near_distance = kAnyDistance;
  view.lens_diameter = 2 * lens_radius_;
  if (has_lens()) view.focus_distance = focus_distance_;
  return view;
}

float Camera::frame_time() const { return shutter_frames() > 0 ? -shutter_.x / shutter_frames() : 0.0f; }

M44f Camera::world_to_camera() const {
  const Pose& p = frame_;
  const V3d position = V3d(p.position) + V3d(origin_);
  const auto shift = [&](const V3f& axis) { return static_cast<float>(-position.dot(V3d(axis))); };
  return {p.right.x,      p.up.x,      p.forward.x,      0,  //
          p.right.y,      p.up.y,      p.forward.y,      0,  //
          p.right.z,      p.up.z,      p.forward.z,      0,  //
          shift(p.right), shift(p.up), shift(p.forward), 1};
}

M44f Camera::world_to_ndc() const {
  const float aspect = this->aspect();
  const float y = 0.5f / frame_.half_height;
  const float x = y / aspect;
  const float axis_x = 0.5f - shift_.x, axis_y = 0.5f + shift_.y;  // of the view axis
  if (parallel_)  // (x, y, z, 1) -> (x' + 1/2, 1/2 - y', z, 1)
    return world_to_camera() * M44f(x, 0, 0, 0, 0, -y, 0, 0, 0, 0, 1, 0, axis_x, axis_y, 0, 1);
  // camera (x, y, z, 1) -> (x' + z/2, z/2 - y', z, z)
  const M44f projection(x, 0, 0, 0,            //
                        0, -y, 0, 0,           //
                        axis_x, axis_y, 1, 1,  //
                        0, 0, 0, 0);
  return world_to_camera() * projection;
}

}  // namespace pelage
