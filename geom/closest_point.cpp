// SPDX-License-Identifier: Apache-2.0
#include "geom/closest_point.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "base/job.h"
#include "geom/triangle_distance.h"

namespace pelage {

namespace {

constexpr uint32_t kPacket = 4;           // triangles that are tested together
constexpr uint32_t kWidth = 2 * kPacket;  // children of a node
constexpr uint32_t kTrianglesPerCheck = 4096;
constexpr uint32_t kLeaf = 1u << 31;
constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

/// One lane in all lanes.
template <int kLane>
Four spread(Four v) {
  return __builtin_shufflevector(v, v, kLane, kLane, kLane, kLane);
}

struct FourBoxes {
  FourVectors low, high;
};

/// Boxes of up to eight children, one per lane, in a space whose z axis is the mean normal of the triangles:
/// there, boxes of a smooth skin are flat. Lanes without a child have an empty box at infinite distance.
struct Node {
  Four origin{};                            // x, y, z, 0
  Four axes[3] = {{1}, {0, 1}, {0, 0, 1}};  // images of the axes of the mesh's space
  FourBoxes boxes[kWidth / kPacket];
  uint32_t child[kWidth];  // a node, or kLeaf and a packet

  Four to_local(Four point) const {
    const Four d = point - origin;
    return axes[0] * spread<0>(d) + axes[1] * spread<1>(d) + axes[2] * spread<2>(d);
  }
};

/// Squares of the distances from a point to four boxes, or a bit less, because of the rounding of far points.
Four box_distances(const FourBoxes& boxes, const FourVectors& point) {
  const FourVectors below = boxes.low - point, above = point - boxes.high;
  const FourVectors outside{larger(larger(below.x, above.x), four(0)),
                            larger(larger(below.y, above.y), four(0)),
                            larger(larger(below.z, above.z), four(0))};
  return outside.dot(outside) * four(0.99999f);
}

/// Component of vectors by axis.
Four& axis_of(FourVectors& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

}  // namespace

struct ClosestPointTree::Impl {
  struct Range {
    uint32_t begin, end;
    uint32_t size() const { return end - begin; }
  };
  /// Data of a triangle during the build.
  struct Item {
    V3f centre;  // of the box of the triangle
    V3f normal;  // as long as twice the area
    uint32_t triangle;
  };

  Impl(const SkinMesh& skin, int motion_key, const Job* own_job) : mesh(skin), key(motion_key), job(own_job) {
    const auto count = static_cast<uint32_t>(mesh.triangle_count());
    if (count == 0) return;
    list_triangles_of_vertices();
    std::vector<Item> items(count);
    float farthest = 0;
    for (uint32_t t = 0; t < count; ++t) {
      const V3f corners[3] = {corner(t, 0), corner(t, 1), corner(t, 2)};
      Box3f box;
      for (const V3f& p : corners) {
        box.extendBy(p);
        farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
      }
      items[t].centre = box.center();
      items[t].normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      items[t].triangle = t;
    }
    // Boxes are larger by this margin, so that rounding never leaves out the nearest triangle. In the space
    // of a node, a corner and the query together are off by up to 1.5e-6 of the largest coordinate;
    // packet_distances() is off by less.
    pad = 4e-6f * farthest;
    packets.reserve(count / kPacket + 1);
    nodes.reserve(count / 7 + 2);  // the max, so that they are never copied
    root = build(items, {0, count});
    job = nullptr;
  }

  V3f corner(uint32_t triangle, uint32_t i) const {
    return mesh.position(mesh.triangles[triangle * 3 + i], key);
  }
  Triangle triangle_at(uint32_t t) const { return {V3d(corner(t, 0)), V3d(corner(t, 1)), V3d(corner(t, 2))}; }

  void list_triangles_of_vertices() {
    first_use.assign(mesh.vertex_count() + 1, 0);
    for (uint32_t v : mesh.triangles) ++first_use[v + 1];
    for (size_t v = 1; v < first_use.size(); ++v) first_use[v] += first_use[v - 1];
    uses.resize(mesh.triangles.size());
    std::vector<uint32_t> next(first_use.begin(), first_use.end() - 1);
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) uses[next[mesh.triangles[i]]++] = i / 3;
  }

  /// Halves a range at a multiple of the packet size, across the longest side of its centres.
  static Range split(std::vector<Item>& items, Range& range) {
    Box3f centres;
    for (uint32_t i = range.begin; i < range.end; ++i) centres.extendBy(items[i].centre);
    const auto axis = centres.majorAxis();
    const uint32_t middle = range.begin + (range.size() / 2 + kPacket - 1) / kPacket * kPacket;
    std::nth_element(items.begin() + range.begin, items.begin() + middle, items.begin() + range.end,
                     [&](const Item& a, const Item& b) {
                       const float x = a.centre[axis], y = b.centre[axis];
                       return x != y ? x < y : a.triangle < b.triangle;
                     });
    const Range rest{middle, range.end};
    range.end = middle;
    return rest;
  }

  /// Returns a node without children, whose space lies along the skin if most triangles face the same way.
  static Node space_of(const std::vector<Item>& items, Range range) {
    constexpr float kMostly = 0.5f;
    V3f sum(0);
    float total = 0;
    for (uint32_t i = range.begin; i < range.end; ++i) {
      sum += items[i].normal;
      total += items[i].normal.length();
    }
    Node node;
    const V3f& centre = items[range.begin].centre;
    if (std::isfinite(centre.x + centre.y + centre.z)) node.origin = Four{centre.x, centre.y, centre.z, 0};
    // A sum of denormal numbers has no exact direction.
    if (!(sum.length() > std::max(kMostly * total, 1e-30f))) return node;
    const V3f z = sum.normalized();
    const V3f x = z.cross(std::fabs(z.x) < 0.5f ? V3f(1, 0, 0) : V3f(0, 1, 0)).normalized(), y = z.cross(x);
    for (int k = 0; k < 3; ++k) node.axes[k] = Four{x[k], y[k], z[k], 0};
    return node;
  }

  uint32_t build(std::vector<Item>& items, Range range) {
    if (range.size() <= kPacket) return make_packet(items, range);
    if (job && range.size() > kTrianglesPerCheck) job->check_stop();
    const Range all = range;
    Range children[kWidth] = {range};
    uint32_t count = 1;
    while (count < kWidth) {
      Range* largest = std::max_element(children, children + count,
                                        [](const Range& a, const Range& b) { return a.size() < b.size(); });
      if (largest->size() <= kPacket) break;
      children[count] = split(items, *largest);
      ++count;
    }
    const auto index = static_cast<uint32_t>(nodes.size());
    nodes.emplace_back();
    Node node = space_of(items, all);
    for (uint32_t lane = 0; lane < kWidth; ++lane) {
      constexpr float kFar = std::numeric_limits<float>::infinity();
      Four low = four(kFar), high = lane < count ? four(-kFar) : four(kFar);
      for (uint32_t i = children[lane].begin; lane < count && i < children[lane].end; ++i) {
        for (uint32_t k = 0; k < 3; ++k) {
          const V3f p = corner(items[i].triangle, k);
          const Four local = node.to_local(Four{p.x, p.y, p.z, 0});
          low = smaller(local - four(pad), low);  // not numbers are ignored
          high = larger(local + four(pad), high);
        }
      }
      for (int axis = 0; axis < 3; ++axis) {
        FourBoxes& boxes = node.boxes[lane / kPacket];
        axis_of(boxes.low, axis)[lane % kPacket] = low[axis];
        axis_of(boxes.high, axis)[lane % kPacket] = high[axis];
      }
    }
    nodes[index] = node;
    for (uint32_t lane = 0; lane < kWidth; ++lane) {
      const uint32_t child = lane < count ? build(items, children[lane]) : kNone;
      nodes[index].child[lane] = child;
    }
    return index;
  }

  uint32_t make_packet(const std::vector<Item>& items, Range range) {
    TrianglePacket packet;
    for (uint32_t lane = 0; lane < kPacket; ++lane) {
      // The last triangle fills unused lanes.
      const uint32_t triangle = items[std::min(range.begin + lane, range.end - 1)].triangle;
      packet.triangle[lane] = triangle;
      for (uint32_t i = 0; i < 3; ++i) {
        const V3f p = corner(triangle, i);
        for (int axis = 0; axis < 3; ++axis) axis_of(packet.corner[i], axis)[lane] = p[axis];
      }
    }
    packets.push_back(packet);
    return kLeaf | static_cast<uint32_t>(packets.size() - 1);
  }

  /// Triangle nearest to `point` with a squared distance up to `limit`, or kNone.
  uint32_t find(const V3f& point, float limit) const {
    struct Visit {
      uint32_t child;
      float distance;
    };
    const Four place{point.x, point.y, point.z, 0};
    // Every level leaves at most seven children pending.
    Visit stack[(kWidth - 1) * 32];
    size_t depth = 0;
    float best = limit;
    uint32_t found = kNone;
    Visit now{root, 0};
    while (true) {
      if (now.distance <= best) {
        if (now.child & kLeaf) {
          const TrianglePacket& packet = packets[now.child & ~kLeaf];
          const Four distances = packet_distances(packet, point);
          for (uint32_t near = lane_bits(distances <= four(best)); near != 0; near &= near - 1) {
            const auto lane = static_cast<uint32_t>(std::countr_zero(near));
            const bool nearer =
                distances[lane] < best || (distances[lane] == best && packet.triangle[lane] < found);
            if (nearer) {
              best = distances[lane];
              found = packet.triangle[lane];
            }
          }
        } else {
          const Node& node = nodes[now.child];
          const Four local = node.to_local(place);
          const FourVectors lanes{spread<0>(local), spread<1>(local), spread<2>(local)};
          alignas(Four) float distances[kWidth];
          uint32_t near = 0;
          for (uint32_t part = 0; part < kWidth / kPacket; ++part) {
            const Four squares = box_distances(node.boxes[part], lanes);
            store_four(distances + kPacket * part, squares);
            near |= lane_bits(squares <= four(best)) << (kPacket * part);
          }
          // Nearest on top. A node as far as the best hit may contain a triangle with a lower number.
          const size_t bottom = depth;
          for (; near != 0; near &= near - 1) {
            const auto lane = static_cast<uint32_t>(std::countr_zero(near));
            if (node.child[lane] == kNone) continue;
            size_t at = depth++;
            for (; at > bottom && stack[at - 1].distance < distances[lane]; --at) stack[at] = stack[at - 1];
            stack[at] = {node.child[lane], distances[lane]};
          }
        }
      }
      if (depth == 0) return found;
      now = stack[--depth];
    }
  }

  /// Sets the place of the nearest point within `limit`, and its triangle.
  std::optional<NearestOnTriangle> nearest(const V3f& point, float limit, ClosestPoint& result) const;

  V3d face_normal(uint32_t triangle) const { return triangle_at(triangle).normal(); }

  /// The normal that gives the side of the surface for every point nearest to this feature [Baerentzen05].
  V3d pseudonormal(uint32_t triangle, const NearestOnTriangle& nearest) const {
    if (nearest.feature == NearestOnTriangle::Feature::kFace) return face_normal(triangle);
    V3d sum(0);
    const uint32_t vertex = mesh.triangles[triangle * 3 + nearest.corner];
    const uint32_t other = mesh.triangles[triangle * 3 + (nearest.corner + 1) % 3];
    const bool at_vertex = nearest.feature == NearestOnTriangle::Feature::kVertex;
    for (uint32_t use = first_use[vertex]; use < first_use[vertex + 1]; ++use) {
      const uint32_t* corners = &mesh.triangles[size_t(uses[use]) * 3];
      if (at_vertex) {
        const auto i = static_cast<size_t>(std::find(corners, corners + 3, vertex) - corners);
        sum += face_normal(uses[use]) * triangle_at(uses[use]).angle(i);
      } else if (std::find(corners, corners + 3, other) != corners + 3) {
        sum += face_normal(uses[use]);
      }
    }
    return sum;
  }

  const SkinMesh& mesh;
  int key;
  const Job* job;  // during the build
  float pad = 0;
  uint32_t root = kNone;
  std::vector<Node> nodes;
  std::vector<TrianglePacket> packets;
  std::vector<uint32_t> first_use;  // vertex_count + 1 entries into uses
  std::vector<uint32_t> uses;       // triangles around each vertex, in order
};

ClosestPointTree::ClosestPointTree(const SkinMesh& mesh, int key, const Job* job)
    : impl_(std::make_unique<Impl>(mesh, key, job)) {}
ClosestPointTree::~ClosestPointTree() = default;
ClosestPointTree::ClosestPointTree(ClosestPointTree&&) noexcept = default;

std::optional<NearestOnTriangle> ClosestPointTree::Impl::nearest(const V3f& point, float limit,
                                                                 ClosestPoint& result) const {
  if (root == kNone || !(limit >= 0)) return {};
  const uint32_t triangle = find(point, limit * limit);
  if (triangle == kNone) return {};
  const NearestOnTriangle on_triangle = nearest_on_triangle(triangle_at(triangle), V3d(point));
  result.position = V3f(on_triangle.position);
  result.distance = static_cast<float>((V3d(point) - on_triangle.position).length());
  result.triangle = triangle;
  return on_triangle;
}

bool ClosestPointTree::closest_position(const V3f& point, float limit, ClosestPoint& result) const {
  return impl_->nearest(point, limit, result).has_value();
}

bool ClosestPointTree::closest(const V3f& point, float limit, ClosestPoint& result) const {
  const Impl& tree = *impl_;
  const std::optional<NearestOnTriangle> found = tree.nearest(point, limit, result);
  if (!found) return false;
  const NearestOnTriangle& nearest = *found;
  const uint32_t triangle = result.triangle;
  const V3d away = V3d(point) - nearest.position;
  result.inside = away.dot(tree.pseudonormal(triangle, nearest)) < 0;
  V3d normal(0);
  for (uint32_t i = 0; i < 3; ++i) {
    normal += V3d(tree.mesh.normal(tree.mesh.triangles[triangle * 3 + i], tree.key)) *
              nearest.weights[static_cast<int>(i)];
  }
  if (!(normal.length() > 1e-6)) normal = tree.face_normal(triangle);
  result.normal = V3f(normal.normalized());
  return true;
}

size_t ClosestPointTree::bytes() const {
  return sizeof(Impl) + impl_->nodes.capacity() * sizeof(Node) +
         impl_->packets.capacity() * sizeof(TrianglePacket) +
         (impl_->first_use.capacity() + impl_->uses.capacity()) * sizeof(uint32_t);
}

}  // namespace pelage
