// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/parallel.h"
#include "render/accel/chunk_tree.h"

namespace pelage {
namespace {

constexpr int kChunkBins = 16;
constexpr size_t kJob = 4096;  // max parts of a subtree that one worker builds
// Below this depth ranges are halved by number, 16-fold per two levels: 2^31 parts end 16 levels further
// down, and their 3 pending siblings per level fit ChunkWalk's stack.
constexpr int kMaxSahDepth = 22;

struct PartBounds {
  V3f low{std::numeric_limits<float>::infinity()};
  V3f high{-std::numeric_limits<float>::infinity()};

  void add(const V3f& p) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  void add(const PartBounds& b) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], b.low[i]);
      high[i] = std::max(high[i], b.high[i]);
    }
  }
  float area() const {
    const V3f d = high - low;
    return d.x >= 0 ? d.x * d.y + d.y * d.z + d.z * d.x : 0;
  }
};

/// A part during the build: its box over all time, and the index of its boxes per key.
struct ChunkPart {
  PartBounds bounds;
  uint32_t chunk = 0, part = 0;

  float centre(int axis) const { return bounds.low[axis] + bounds.high[axis]; }  // times two
};

struct Range {
  size_t begin = 0, end = 0;
  PartBounds bounds;
  size_t count() const { return end - begin; }
};

struct Bin {
  PartBounds bounds;
  size_t count = 0;
};

/// Distribution of parts into bins by the centre of their box along one axis.
struct Binning {
  int axis = 0;
  float low = 0, scale = 0;
  int bin(const ChunkPart& part) const {
    const float x = (part.centre(axis) - low) * scale;
    return std::clamp(static_cast<int>(x), 0, kChunkBins - 1);
  }
};

}  // namespace

/// Builds a ChunkTree top-down: repeatedly splits the range with the largest area by the surface area
/// heuristic [Wald07], until a node has four children.
class ChunkTreeBuilder {
 public:
  ChunkTreeBuilder(ChunkTree& tree, std::span<const ChunkBounds> chunks) : tree_(tree), chunks_(chunks) {
    for (uint32_t c = 0; c < chunks.size(); ++c) {
      for (uint32_t p = 0; p < chunks[c].part_count(); ++p) {
        ChunkPart part;
        part.chunk = c;
        part.part = p;
        for (int key = 0; key < chunks[c].keys; ++key) {
          const Box3f& box = chunks[c].box(p, key);
          part.bounds.add({box.min, box.max});
        }
        if (!(part.bounds.low.x <= part.bounds.high.x)) continue;  // empty part
        moving_ |= chunks[c].keys > 1;
        parts_.push_back(part);
      }
    }
  }

  void build(const Workers& workers) {
    if (parts_.empty()) return;
    const Range all = range(0, parts_.size());
    tree_.bounds_ = Box3f(all.bounds.low, all.bounds.high);
    for (int i = 0; i < 3; ++i) {
      tree_.reach_ = std::max({tree_.reach_, std::abs(all.bounds.low[i]), std::abs(all.bounds.high[i])});
    }
    Nodes top;
    add_node(all, 0, top, true);
    std::vector<Nodes> below(jobs_.size());
    workers.for_each(jobs_.size(), 1, [&](WorkRange job) {
      for (size_t i = job.begin; i < job.end; ++i) add_node(jobs_[i].range, jobs_[i].depth, below[i], false);
    });
    join(top, below);
  }

 private:
  struct Nodes {
    std::vector<ChunkTree::Node> nodes;
    std::vector<FourBoxes> motions;
  };
  struct Job {
    Range range;
    int depth;
    uint32_t parent;
    size_t lane;
  };

  Range range(size_t begin, size_t end) const {
    Range r{begin, end, {}};
    for (size_t i = begin; i < end; ++i) r.bounds.add(parts_[i].bounds);
    return r;
  }

  /// Adds the node over a range and everything below it; in the top of the tree, small ranges become jobs
  /// instead.
  uint32_t add_node(const Range& all, int depth, Nodes& out, bool top) {
    std::array<Range, 4> children;
    const size_t count = divide(all, depth, children);
    const auto index = static_cast<uint32_t>(out.nodes.size());
    out.nodes.push_back(empty_node());
    if (moving_) out.motions.push_back(still());
    for (size_t lane = 0; lane < count; ++lane) {
      const Range& child = children[lane];
      set_boxes(child, lane, index, out);
      if (child.count() == 1) {
        out.nodes[index].children[lane] = ChunkTree::kChunk | parts_[child.begin].chunk;
      } else if (top && child.count() <= kJob) {
        jobs_.push_back({child, depth + 1, index, lane});
      } else {
        const uint32_t below = add_node(child, depth + 1, out, top);
        out.nodes[index].children[lane] = below;
      }
    }
    return index;
  }

  size_t divide(const Range& all, int depth, std::array<Range, 4>& children) {
    children[0] = all;
    size_t count = 1;
    while (count < 4) {
      size_t widest = 4;
      for (size_t i = 0; i < count; ++i) {
        if (children[i].count() < 2) continue;
        if (widest == 4 || weight(children[i], depth) > weight(children[widest], depth)) widest = i;
      }
      if (widest == 4) break;
      const size_t middle = split(children[widest], depth);
      children[count++] = range(middle, children[widest].end);
      children[widest] = range(children[widest].begin, middle);
    }
    return count;
  }
  static float weight(const Range& r, int depth) {
    return depth < kMaxSahDepth ? r.bounds.area() : static_cast<float>(r.count());
  }

  size_t split(const Range& r, int depth) {
    const auto begin = parts_.begin() + static_cast<std::ptrdiff_t>(r.begin);
    const auto end = parts_.begin() + static_cast<std::ptrdiff_t>(r.end);
    Binning best;
    int first_above = 0;
    if (depth < kMaxSahDepth && find_split(r, best, first_above)) {
      const auto middle =
          std::partition(begin, end, [&](const ChunkPart& part) { return best.bin(part) < first_above; });
      if (middle != begin && middle != end) return static_cast<size_t>(middle - parts_.begin());
    }
    return r.begin + r.count() / 2;
  }

  bool find_split(const Range& r, Binning& best, int& first_above) const {
    PartBounds centres;
    for (size_t i = r.begin; i < r.end; ++i) {
      centres.add(V3f(parts_[i].centre(0), parts_[i].centre(1), parts_[i].centre(2)));
    }
    float best_cost = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = centres.high[axis] - centres.low[axis];
      if (!(extent > 0) || !std::isfinite(kChunkBins / extent)) continue;
      const Binning binning{axis, centres.low[axis], kChunkBins / extent};
      std::array<Bin, kChunkBins> bins;
      for (size_t i = r.begin; i < r.end; ++i) {
        Bin& bin = bins[static_cast<size_t>(binning.bin(parts_[i]))];
        bin.bounds.add(parts_[i].bounds);
        ++bin.count;
      }
      std::array<float, kChunkBins> above{};  // cost of bins i and higher
      Bin sum;
      for (size_t i = kChunkBins; i-- > 0;) {
        sum.bounds.add(bins[i].bounds);
        sum.count += bins[i].count;
        above[i] = sum.bounds.area() * static_cast<float>(sum.count);
      }
      sum = {};
      for (size_t i = 0; i + 1 < kChunkBins; ++i) {
        sum.bounds.add(bins[i].bounds);
        sum.count += bins[i].count;
        const float cost = sum.bounds.area() * static_cast<float>(sum.count) + above[i + 1];
        if (sum.count > 0 && sum.count < r.count() && cost < best_cost) {
          best_cost = cost;
          best = binning;
          first_above = static_cast<int>(i) + 1;
        }
      }
    }
    return best_cost < std::numeric_limits<float>::infinity();
  }

  static ChunkTree::Node empty_node() {
    ChunkTree::Node node;
    for (auto& axis : node.boxes) {
      axis[0] = four(std::numeric_limits<float>::infinity());
      axis[1] = four(-std::numeric_limits<float>::infinity());
    }
    node.children.fill(ChunkTree::kChunk);
    return node;
  }
  static FourBoxes still() {
    FourBoxes motion;
    for (auto& axis : motion) axis[0] = axis[1] = four(0);
    return motion;
  }

  void set_boxes(const Range& child, size_t lane, uint32_t index, Nodes& out) const {
    if (!moving_) {
      set_sides(out.nodes[index].boxes, lane, child.bounds.low, child.bounds.high);
      return;
    }
    PartBounds open, close;
    for (size_t i = child.begin; i < child.end; ++i) {
      const ChunkBounds& bounds = chunks_[parts_[i].chunk];
      const Box3f& first = bounds.box(parts_[i].part, 0);
      const Box3f& last = bounds.box(parts_[i].part, bounds.keys - 1);
      open.add({first.min, first.max});
      close.add({last.min, last.max});
    }
    set_sides(out.nodes[index].boxes, lane, open.low, open.high);
    set_sides(out.motions[index], lane, close.low - open.low, close.high - open.high);
  }
  static void set_sides(FourBoxes& boxes, size_t lane, const V3f& low, const V3f& high) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[static_cast<size_t>(axis)][0][lane] = low[axis];
      boxes[static_cast<size_t>(axis)][1][lane] = high[axis];
    }
  }

  void join(const Nodes& top, const std::vector<Nodes>& below) {
    size_t total = top.nodes.size();
    for (const Nodes& n : below) total += n.nodes.size();
    PELAGE_CHECK(total < ChunkTree::kChunk);
    tree_.nodes_.reserve(total);
    tree_.nodes_ = top.nodes;
    tree_.nodes_.reserve(total);
    if (moving_) tree_.motions_.reserve(total);
    tree_.motions_.insert(tree_.motions_.end(), top.motions.begin(), top.motions.end());
    for (size_t j = 0; j < below.size(); ++j) {
      const auto offset = static_cast<uint32_t>(tree_.nodes_.size());
      tree_.nodes_[jobs_[j].parent].children[jobs_[j].lane] = offset;
      for (ChunkTree::Node node : below[j].nodes) {
        for (uint32_t& child : node.children) {
          if (!(child & ChunkTree::kChunk)) child += offset;
        }
        tree_.nodes_.push_back(node);
      }
      tree_.motions_.insert(tree_.motions_.end(), below[j].motions.begin(), below[j].motions.end());
    }
  }

  ChunkTree& tree_;
  std::span<const ChunkBounds> chunks_;
  std::vector<ChunkPart> parts_;
  std::vector<Job> jobs_;
  bool moving_ = false;
};

ChunkTree::ChunkTree(std::span<const ChunkBounds> chunks, const Workers& workers) {
  PELAGE_CHECK(chunks.size() < kChunk);
  ChunkTreeBuilder(*this, chunks).build(workers);
}

}  // namespace pelage
