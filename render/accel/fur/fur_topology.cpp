// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_topology.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/accel/fur/fur_leaf.h"
#include "render/accel/fur/fur_reference.h"

namespace pelage {
namespace {

constexpr size_t kBlockPieces = FurBlockHeader::kLanes;
constexpr size_t kBins = 16;
constexpr size_t kSweep = 96;  // sets up to this size are swept exactly
constexpr size_t kMinPieces =
    32;                       // min number of pieces on a side of a bin split, unless they fill their blocks
constexpr int kDeepest = 40;  // max levels of binary splits by area; deeper ranges are halved
constexpr float kFar = 1e30f;

size_t blocks(size_t pieces) { return (pieces + kBlockPieces - 1) / kBlockPieces; }

struct PieceBounds {
  Four low = four(kFar), high = four(-kFar);
  void extend(const Four& l, const Four& h) {
    low = smaller(low, l);
    high = larger(high, h);
  }
  float area() const {
    const Four d = high - low;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

PieceBounds hull_of(const SnappedSegment& segment) {
  PieceBounds hull;
  for (const std::array<float, 4>& p : segment) {
    const Four point{p[0], p[1], p[2], p[3]}, radius = four(p[3]);
    hull.extend(point - radius, point + radius);
  }
  return hull;
}

struct Split {
  float cost = kFar;
  int axis = -1;
  size_t place = 0;  // number of bins, or pieces, on the left
};

class Builder {
 public:
  Builder(std::vector<FurPiece> pieces, const FurBuildOptions& options)
      : pieces_(std::move(pieces)), options_(options) {}

  FurTopology build() {
    if (pieces_.empty()) return {};
    tree_.nodes.reserve(topology_bound(pieces_.size()).nodes);
    tree_.nodes.emplace_back();
    build_node(0, {0, pieces_.size(), 0, kFar});
    tree_.order.reserve(pieces_.size());
    for (const FurPiece& piece : pieces_) tree_.order.push_back(piece.number());
    return std::move(tree_);
  }

 private:
  struct Range {
    size_t begin = 0, end = 0;
    int depth = 0;
    float area = 0;
    size_t size() const { return end - begin; }
    size_t block_count() const { return blocks(size()); }
  };

  void build_node(size_t index, const Range& range) {
    Range children[4] = {range};
    size_t count = 1;
    while (count < 4) {
      // The largest range that can still be split.
      Range* widest = nullptr;
      for (Range& child : std::span(children, count)) {
        if (child.block_count() > 1 && (!widest || child.area > widest->area)) widest = &child;
      }
      if (!widest) break;
      const Range whole = *widest;
      split(whole, *widest, children[count]);
      ++count;
    }
    tree_.nodes[index].child_count = static_cast<uint32_t>(count);
    for (size_t i = 0; i < count; ++i) {
      FurTopology::Child child;
      if (is_leaf(children[i])) {
        child.first = static_cast<uint32_t>(children[i].begin);
        child.count = static_cast<uint32_t>(children[i].size());
      } else {
        child.node = static_cast<uint32_t>(tree_.nodes.size());
        tree_.nodes.emplace_back();
        build_node(child.node, children[i]);
      }
      tree_.nodes[index].children[i] = child;
    }
  }

  bool is_leaf(const Range& range) {
    if (range.block_count() <= 1) return true;
    if (range.block_count() > 2) return false;
    Range left, right;
    split(range, left, right);
    const float tests = left.area + right.area + options_.node_cost * range.area;
    return tests >= 2 * range.area;
  }

  /// Sorts the pieces of `range` into two ranges.
  void split(const Range& range, Range& left, Range& right) {
    size_t middle = 0;
    if (range.depth >= kDeepest) {
      middle = range.begin + blocks(range.size()) / 2 * kBlockPieces;
    } else if (range.size() <= kSweep) {
      middle = sweep(range);
    } else {
      middle = partition_bins(range);
    }
    left = {range.begin, middle, range.depth + 1, 0};
    right = {middle, range.end, range.depth + 1, 0};
    left.area = bounds(left).area();
    right.area = bounds(right).area();
  }

  PieceBounds bounds(const Range& range) const {
    PieceBounds result;
    for (size_t i = range.begin; i < range.end; ++i) result.extend(pieces_[i].low, pieces_[i].high);
    return result;
  }

  size_t partition_bins(const Range& range) {
    PieceBounds centres;
    for (size_t i = range.begin; i < range.end; ++i) {
      const Four centre = pieces_[i].low + pieces_[i].high;
      centres.extend(centre, centre);
    }
    const Four extent = centres.high - centres.low;
    // Flat axes have a single bin.
    const Four scale = extent > four(0) ? four(0.9999f * kBins) / extent : four(0);
    const auto bins_of = [&](const FurPiece& piece) {
      return __builtin_convertvector((piece.low + piece.high - centres.low) * scale,
                                     int __attribute__((vector_size(16))));
    };
    PieceBounds bins[3][kBins];
    size_t counts[3][kBins] = {};
    for (size_t i = range.begin; i < range.end; ++i) {
      const auto bin = bins_of(pieces_[i]);
      for (int axis = 0; axis < 3; ++axis) {
        const auto b = static_cast<size_t>(bin[axis]);
        bins[axis][b].extend(pieces_[i].low, pieces_[i].high);
        ++counts[axis][b];
      }
    }
    Split best;
    for (int axis = 0; axis < 3; ++axis) choose_bin(bins[axis], counts[axis], range.size(), axis, best);
    if (best.axis < 0) return range.begin + blocks(range.size()) / 2 * kBlockPieces;
    const auto first = pieces_.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto last = pieces_.begin() + static_cast<std::ptrdiff_t>(range.end);
    const auto middle = std::partition(first, last, [&](const FurPiece& piece) {
      return static_cast<size_t>(bins_of(piece)[best.axis]) < best.place;
    });
    return static_cast<size_t>(middle - pieces_.begin());
  }

  static void choose_bin(const PieceBounds (&bins)[kBins], const size_t (&counts)[kBins], size_t all,
                         int axis, Split& best) {
    float right_area[kBins];
    PieceBounds right;
    for (size_t i = kBins; i-- > 1;) {
      right.extend(bins[i].low, bins[i].high);
      right_area[i] = right.area();
    }
    PieceBounds left;
    size_t count = 0;
    for (size_t i = 1; i < kBins; ++i) {
      left.extend(bins[i - 1].low, bins[i - 1].high);
      count += counts[i - 1];
      if (count == 0 || count == all) continue;
      // Without this condition, the number of half-filled blocks would be unbounded.
      if (std::min(count, all - count) < kMinPieces && count % kBlockPieces != 0) continue;
      const float cost = left.area() * static_cast<float>(blocks(count)) +
                         right_area[i] * static_cast<float>(blocks(all - count));
      if (cost < best.cost) best = {cost, axis, i};
    }
  }

  /// Sorts the pieces along the best axis; returns the best split position that is a multiple of four.
  size_t sweep(const Range& range) {
    const size_t n = range.size();
    const FurPiece* pieces = &pieces_[range.begin];
    uint64_t keys[3][kSweep];
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      for (size_t i = 0; i < n; ++i) {
        keys[axis][i] = sortable(pieces[i].low[axis] + pieces[i].high[axis]) << 32 | i;
      }
      std::sort(keys[axis], keys[axis] + n);
      float right_area[kSweep / kBlockPieces + 1];
      PieceBounds right;
      for (size_t i = n; i-- > kBlockPieces;) {
        const FurPiece& piece = pieces[keys[axis][i] & 0xffffffff];
        right.extend(piece.low, piece.high);
        if (i % kBlockPieces == 0) right_area[i / kBlockPieces] = right.area();
      }
      PieceBounds left;
      for (size_t i = 0; i + kBlockPieces < n; i += kBlockPieces) {
        for (size_t j = i; j < i + kBlockPieces; ++j) {
          const FurPiece& piece = pieces[keys[axis][j] & 0xffffffff];
          left.extend(piece.low, piece.high);
        }
        const size_t count = i + kBlockPieces;
        const float cost = left.area() * static_cast<float>(blocks(count)) +
                           right_area[count / kBlockPieces] * static_cast<float>(blocks(n - count));
        if (cost < best.cost) best = {cost, axis, count};
      }
    }
    if (best.axis < 0) return range.begin + blocks(n) / 2 * kBlockPieces;
    FurPiece sorted[kSweep];
    for (size_t i = 0; i < n; ++i) sorted[i] = pieces[keys[best.axis][i] & 0xffffffff];
    std::copy_n(sorted, n, &pieces_[range.begin]);
    return range.begin + best.place;
  }

  /// Monotonic in x.
  static uint64_t sortable(float x) {
    const auto bits = std::bit_cast<uint32_t>(x);
    return bits >> 31 != 0 ? ~bits : bits | 0x80000000u;
  }

  std::vector<FurPiece> pieces_;
  const FurBuildOptions options_;
  FurTopology tree_;
};

}  // namespace

FurPiece::FurPiece(const Four& box_low, const Four& box_high, uint32_t number)
    : low(box_low), high(box_high) {
  low[3] = std::bit_cast<float>(number);
}

uint32_t FurPiece::number() const {
  const float number = low[3];
  return std::bit_cast<uint32_t>(number);
}

std::vector<FurPiece> make_pieces(const SnappedStrands& strands, const FurFrame& frame) {
  std::vector<FurPiece> pieces;
  pieces.reserve(strands.segment_count());
  const Four share = four(1.0f / static_cast<float>(strands.motion_keys()));
  strands.for_each_segment([&](uint32_t number, SnappedStrands::Place place) {
    Four low = four(0), high = four(0);
    for (int key = 0; key < strands.motion_keys(); ++key) {
      const SnappedSegment segment = strands.segment(place, key);
      if (!SnappedStrands::is_visible(segment)) return;
      const PieceBounds hull = hull_of(frame(segment));
      low = low + hull.low, high = high + hull.high;
    }
    pieces.emplace_back(low * share, high * share, number);
  });
  return pieces;
}

FurTopologySize topology_bound(size_t pieces) {
  // A split adds one partially filled block, unless it falls between blocks; that happens only where both
  // sides are large. Nodes above other nodes have four children, the others two blocks or more.
  const size_t max = blocks(pieces) + pieces / kMinPieces;
  return {2 * max / 3 + 1, max};
}

FurTopology build_topology(std::vector<FurPiece> pieces, const FurBuildOptions& options) {
  return Builder(std::move(pieces), options).build();
}

}  // namespace pelage
