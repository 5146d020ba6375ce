// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/temporary_folder.h"
#include "groom/cache/cache_report.h"
#include "groom/groom.h"
#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"

namespace pelage {

/// Appends warnings to a list.
class KeepsWarnings final : public Progress {
 public:
  explicit KeepsWarnings(std::vector<std::string>& warnings) : warnings_(warnings) {}
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view line) override { warnings_.emplace_back(line); }
  bool cancelled() const override { return false; }

 private:
  std::vector<std::string>& warnings_;
};

/// Coats on a ball, with and without a cache.
class CachedCoatTest : public OperatorTest {
 protected:
  struct Coat {
    std::string operators;
    std::string freeze;  // empty: no cache
    int64_t strands = 1500;
    int leaf = 500;
    int points = 8;
    std::string more = {};  // further keys, each on a line of its own
    std::string name = "coat";
  };

  GroomParams params_of(const Coat& coat) const {
    GroomParams params =
        scene_text::read<GroomParams>("skin: ball\nstrands: " + std::to_string(coat.strands) +
                                      "\nleaf_strands: " + std::to_string(coat.leaf) +
                                      "\npoints: " + std::to_string(coat.points) + "\n" + coat.more);
    params.operators = scene_text::read<OperatorList>(coat.operators);
    if (!coat.freeze.empty()) {
      params.cache.emplace();
      params.cache->directory.path = cache();
      params.cache->freeze.name = coat.freeze;
    }
    return params;
  }
  std::shared_ptr<const Groom> make(const GroomParams& params, const std::string& name = "coat",
                                    int threads = 2) {
    KeepsWarnings progress(warnings_);
    const Workers workers(threads);
    return Groom::create(name, params, rest_, textures_, Job{workers, ledger_, progress});
  }
  std::shared_ptr<const Groom> make(const Coat& coat, int threads = 2) {
    return make(params_of(coat), coat.name, threads);
  }

  static std::vector<Strands> all(const Groom& groom, const PosedSkin& pose) {
    std::vector<Strands> leaves;
    for (size_t leaf = 0; leaf < groom.follicles().leaves().size(); ++leaf)
      leaves.push_back(groom.grow(leaf, pose));
    return leaves;
  }
  /// Every number of every strand.
  static std::vector<float> bits(const Groom& groom, const PosedSkin& pose) {
    std::vector<float> result;
    for (const Strands& strands : all(groom, pose)) {
      for (int key = 0; key < strands.motion_keys(); ++key) {
        const auto points = strands.points(key);
        result.insert(result.end(), points.begin(), points.end());
      }
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        result.push_back(static_cast<float>(strands.id(s)));
        result.push_back(strands.root_uv(s).x);
      }
      for (const StrandAttribute& attribute : strands.attributes())
        result.insert(result.end(), attribute.values.begin(), attribute.values.end());
    }
    return result;
  }
  /// The ball turned, moved and bent a little.
  LimitSurface posed(float turn, float bend) const {
    std::vector<V3f> positions = shapes::ball_cage(1.2f).positions;
    for (V3f& p : positions) {
      const float angle = turn + bend * p.y, c = std::cos(angle), s = std::sin(angle);
      p = V3f(c * p.x + s * p.z + 3, p.y * (1 + 0.2f * bend) - 1, c * p.z - s * p.x);
    }
    return {rest_->shared_topology(), positions};
  }
  PosedSkin at_rest() const { return {{rest_.get(), 1}, {}, 1, {}}; }

  std::filesystem::path cache() const { return folder_.path() / "cache"; }
  std::vector<std::filesystem::path> files(const std::string& kind) const {
    std::vector<std::filesystem::path> found;
    if (!std::filesystem::exists(cache())) return found;
    for (const auto& entry : std::filesystem::directory_iterator(cache())) {
      if (entry.path().filename().string().starts_with(kind + "-")) found.push_back(entry.path());
    }
    return found;
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

inline constexpr const char* kEveryFrozenOperator =
    "- length: {value: {ramp: {along: y, knots: [[-1, 0.2], [1, 0.5]]}}, variation: 0.3}\n"
    "- comb: {direction: [0, -1, 0.3], lift: 0.3, curve: 0.5}\n"
    "- bend: {direction: [1, 0, 0], angle: 30}\n"
    "- clump: {spacing: 0.3, amount: 0.6, variation: 0.3, strays: 0.1, levels: [{spacing: 0.1, amount: "
    "0.5}]}\n"
    "- curl: {radius: 0.02, turns: 2}\n"
    "- frizz: {amplitude: 0.01, frequency: 3}\n"
    "- noise: {amplitude: 0.05, frequency: 2}\n"
    "- width: {root: 0.008, tip: 0.001, variation: 0.2}\n"
    "- color: {value: {ramp: {along: strand, knots: [[0, [0, 1, 0]], [1, [1, 0, 0]]]}}, variation: 0.5}\n";

}  // namespace pelage
