// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "image/texture_library.h"
#include "procedurals/fur.h"
#include "tests/groom/random_stacks.h"
#include "tests/groom/shapes.h"
#include "tests/support/quiet_job.h"

namespace pelage {

struct RandomCoatOptions {
  int motion_keys = 2;
  int64_t strands = 900;
  int leaf_strands = 300;
  bool push_out = false;
  int cage_levels = 2;                         ///< faces of the ball: 6 * 4^levels
  float length = 1;                            // factor on the length that comes from the seed
  std::filesystem::path cache = {};            // of the groom; none when empty
  std::optional<OperatorList> operators = {};  ///< random ones when not given
};

/// A coat on a ball about 4 wide that turns, swells and flies; everything comes from the seed. Its shutter is
/// open for a random part of the frame.
class RandomCoat {
 public:
  RandomCoat(uint64_t seed, const RandomCoatOptions& options) : textures_(ledger_), workers_(2) {
    uint64_t draw = 0;
    const auto between = [&](float low, float high) {
      return low + (high - low) * unit_float(hash64(seed, draw++, random_use("random coat")));
    };
    const ControlMesh cage = shapes::ball_cage(options.cage_levels);
    rest = shapes::surface_of(cage);
    GroomParams params;
    params.skin.name = "ball";
    params.strands = options.strands;
    params.leaf_strands = options.leaf_strands;
    params.points = 4 + static_cast<int>(between(0, 7));
    params.operators = options.operators ? *options.operators : stacks::random(seed, 4, options.push_out);
    if (!options.cache.empty()) {
      params.cache.emplace();
      params.cache->directory.path = options.cache;
      params.cache->freeze.name = Length::kName;
    }
    groom = Groom::create("coat", params, rest, textures_, QuietJob(2, ledger_));

    const float turn = between(-2, 2), swell = between(-0.3f, 0.3f), tilt = between(0, 6);
    // One after the other: the order of a function's arguments depends on the compiler.
    const auto vector = [&](float max) {
      const float z = between(-max, max), y = between(-max, max), x = between(-max, max);
      return V3f(x, y, z);
    };
    const V3f flight = vector(3);
    const V3f place = vector(50);
    const auto pose_at = [&](PosedCages& cages, float t) {
      std::vector<V3f> posed = cage.positions;
      M44f m;
      m.rotate(V3f(tilt, turn * t, 0));
      for (V3f& p : posed) p = p * m * (1 + swell * t) + place + flight * t;
      cages.cages.push_back(std::move(posed));
      cages.transforms.push_back(m);
    };
    CharacterPose pose;
    pose.topology = rest->shared_topology();
    const float open = between(-0.5f, 0), close = between(0, 0.5f);
    for (int k = 0; k < options.motion_keys; ++k) {
      const float t =
          options.motion_keys < 2 ? 0 : static_cast<float>(k) / static_cast<float>(options.motion_keys - 1);
      pose_at(pose.shutter, open + (close - open) * t);
    }
    if (options.motion_keys > 1) {
      for (float t : {-0.5f, 0.5f}) pose_at(pose.frame_ends, t);
    }
    pose.scale = between(0.5f, 2);
    pose.length = options.length * between(0.5f, 1.5f);
    if (options.push_out) pose.push_out_view = View{V3f(0, 0, 60), 300};
    skin = std::make_shared<PosedCharacterSkin>(std::move(pose), std::make_shared<PoseCache>(2, ledger_));
    leaves = FurProcedural(groom, skin).split();
    for (const auto& leaf : leaves) chunks.push_back(leaf.get());
  }

 private:
  MemoryLedger ledger_;
  TextureLibrary textures_;
  Workers workers_;

 public:
  std::shared_ptr<const LimitSurface> rest;
  std::shared_ptr<const Groom> groom;
  std::shared_ptr<const PosedCharacterSkin> skin;
  std::vector<std::unique_ptr<Procedural>> leaves;
  std::vector<const Procedural*> chunks;
};

}  // namespace pelage
