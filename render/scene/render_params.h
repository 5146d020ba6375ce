// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "base/schema.h"
#include "base/value_readers.h"
#include "lod/simplification_params.h"
#include "procedurals/bounds/chunk_bounds.h"
#include "render/camera/camera.h"
#include "render/sampling/adaptive_params.h"
#include "render/scene/gather_params.h"

namespace pelage {

enum class Integrator { kPath, kGather };
template <>
struct EnumNames<Integrator> {
  static constexpr const char* names[] = {"path", "gather"};
};
/// How light that strands scatter more than once is found.
enum class IndirectLight { kPath, kDual };
template <>
struct EnumNames<IndirectLight> {
  static constexpr const char* names[] = {"path", "dual"};
};
enum class AccelKind { kEmbree, kFur };
template <>
struct EnumNames<AccelKind> {
  static constexpr const char* names[] = {"embree", "fur"};
};
enum class CurveShape { kFlat, kRound };
template <>
struct EnumNames<CurveShape> {
  static constexpr const char* names[] = {"flat", "round"};
};
/// How the balls inside skins replace shadow rays.
enum class SkinBallUse { kOff, kExact };
template <>
struct EnumNames<SkinBallUse> {
  static constexpr const char* names[] = {"off", "exact"};
};
/// Returns whether strands are stored in Pelage's own fur trees rather than in Embree. The picture is the
/// same, except for rounding at the edges of strands.
inline bool in_fur_trees(AccelKind accel, CurveShape curves) {
  return accel == AccelKind::kFur && curves == CurveShape::kFlat;
}

/// The camera that determines the level of detail by its distance, motion and focus. It is either the camera
/// of the scene or a separate one.
struct LodCamera {
  std::optional<CameraParams> own;  ///< the separate camera; empty: the camera of the scene
};
template <>
struct ValueReader<LodCamera> {
  static bool read(const Value&, const KeyOptions&, LodCamera& out, Problems&);
  static std::string type_name() { return "main, or block camera"; }
  static std::string print(const LodCamera& camera) { return camera.own ? "{}" : "main"; }
  static void visit_blocks(Value& value, const BlockVisitor& visit) {
    if (value.is_map()) visit(value, CameraParams::schema());
  }
};

/// `lod:` of `render:`.
struct LodParams : SimplificationParams {
  bool enabled = true;
  LodCamera camera;
  static const Schema<LodParams>& schema();
};

/// `bvh:` of `render:`.
struct BvhParams {
  AssetPath file;  ///< folder for stored trees; empty: none are stored
  static const Schema<BvhParams>& schema();
};

/// `render:` of a scene.
struct RenderParams {
  Integrator integrator = Integrator::kGather;
  GatherParams gather;
  AccelKind accel = AccelKind::kFur;
  CurveShape curves = CurveShape::kFlat;
  int samples = 64;  ///< count per pixel; with adaptive sampling, the max count
  std::optional<AdaptiveParams> adaptive;
  float time_limit = 0;   ///< seconds; 0: no limit
  int light_samples = 1;  ///< shadow rays per vertex of a path
  int bounces = 4;        ///< max scatterings after the first; 0: direct light only
  IndirectLight indirect = IndirectLight::kPath;
  std::optional<SkinBallUse> skin_ball;  ///< empty: see ball_use()
  float clamp_indirect = 0;              ///< max luminance of the indirect light of one path; 0: no limit
  int64_t seed = 0;
  ByteSize memory{uint64_t(4) << 30};
  BvhParams bvh;
  bool screen_door = false;  ///< secondary rays see strands that are not opaque as opaque, but narrower
  bool compact_attributes = true;
  BoundingStrategy bounds = BoundingStrategy::kExact;
  LodParams lod;

  /// Returns the max count of scatterings that a path continues after the first.
  int path_bounces() const { return indirect == IndirectLight::kDual ? 0 : bounces; }
  /// Whether the gather integrator draws what the camera sees, instead of tracing camera rays.
  bool draws_visible() const {
    return gather.visibility.value_or(GatherVisibility::kRaster) == GatherVisibility::kRaster &&
           in_fur_trees(accel, curves);
  }
  /// Scenes with more skins are crowds. Crowds have no balls by default: balls would take more time than they
  /// save.
  static constexpr size_t kFewSkins = 8;
  /// Returns what balls inside `skins` skins are used for. By default, `path` traces every ray, because it is
  /// the reference of all faster methods.
  SkinBallUse ball_use(size_t skins) const {
    const bool pays = integrator == Integrator::kGather && skins <= kFewSkins;
    return skin_ball.value_or(pays ? SkinBallUse::kExact : SkinBallUse::kOff);
  }
  /// Up to this number of `bounces`, the reflection cache is off by default. Two bounces end where the cache
  /// would end them. In crowds, an animal covers few pixels, and few paths fill its cells.
  static constexpr int kFewBounces = 2, kFewBouncesInCrowds = 7;
  /// Returns whether indirect paths of `gather` end in the reflection cache, in a scene with `skins` skins.
  bool uses_cache(size_t skins) const {
    const int few = skins <= kFewSkins ? kFewBounces : kFewBouncesInCrowds;
    return gather.reuse && bounces > 0 && gather.cache.value_or(bounces > few);
  }
  /// Returns the width, in pixels, at which the camera sees thinner strands; 0: strands keep their widths.
  float min_width() const {
    return integrator == Integrator::kGather && draws_visible() ? gather.min_width : 0;
  }

  static const Schema<RenderParams>& schema();
};

}  // namespace pelage
