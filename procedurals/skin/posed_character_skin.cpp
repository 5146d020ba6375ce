// SPDX-License-Identifier: Apache-2.0
#include "procedurals/skin/posed_character_skin.h"

#include "base/check.h"
#include "base/parallel.h"

namespace pelage {

namespace {

/// Hash of one time, in order: V3f and M44f are plain floats without padding.
uint64_t hash_of(const PosedCages& cages) {
  uint64_t hash = cages.cages.size();
  for (const std::vector<V3f>& cage : cages.cages) {
    const ContentHash h = content_hash(std::as_bytes(std::span(cage)));
    hash = hash64(hash, h.low, h.high);
  }
  const ContentHash h = content_hash(std::as_bytes(std::span(cages.transforms)));
  return hash64(hash, h.low, h.high);
}

ContentHash hash_of(const CharacterPose& pose) {
  uint64_t words[6] = {pose.topology->hash().low, pose.topology->hash().high,          hash_of(pose.shutter),
                       hash_of(pose.frame_ends),  std::bit_cast<uint32_t>(pose.scale), 0};
  // push_out uses the skin's triangles, which depend on the view.
  if (const auto& view = pose.push_out_view) {
    const float seen[] = {view->position.x, view->position.y, view->position.z, view->focal_pixels,
                          view->near_distance};
    words[5] = content_hash(std::as_bytes(std::span(seen))).low;
  }
  return content_hash(std::as_bytes(std::span(words)));
}

size_t cage_bytes(const PosedCages& cages) {
  size_t sum = cages.transforms.capacity() * sizeof(M44f);
  for (const std::vector<V3f>& cage : cages.cages) sum += cage.capacity() * sizeof(V3f) + sizeof(cage);
  return sum;
}

/// Limit points are averages of control points, but patches near extraordinary vertices have an error of up
/// to 1e-3 of a face (geom/limit_surface.h).
Box3f widened(const Box3f& box) {
  const V3f out(1e-3f * box.size().length());
  return {box.min - out, box.max + out};
}

}  // namespace

PosedCharacterSkin::PosedCharacterSkin(CharacterPose pose, std::shared_ptr<PoseCache> poses)
    : pose_(std::move(pose)), poses_(std::move(poses)), hash_(hash_of(pose_)) {
  PELAGE_CHECK(!pose_.shutter.cages.empty());
  PELAGE_CHECK(pose_.shutter.transforms.size() == pose_.shutter.cages.size());
  PELAGE_CHECK(pose_.frame_ends.cages.size() == pose_.frame_ends.transforms.size());
  PELAGE_CHECK(pose_.frame_ends.cages.empty() || pose_.frame_ends.cages.size() == 2);
  // The size of the trees is known only after making them.
  if (pose_.push_out_view) poses_->reserve(make(BoundSpan::kFrame)->bytes());
}

std::shared_ptr<const SkinPose> PosedCharacterSkin::pose(BoundSpan span) const {
  if (pose_.frame_ends.cages.empty()) span = BoundSpan::kShutter;  // the same
  std::shared_ptr<const SkinPose> pose;
  {
    const std::lock_guard lock(mutex_);
    std::weak_ptr<const SkinPose>& made = made_[static_cast<size_t>(span)];
    pose = made.lock();
    if (!pose) made = pose = make(span);
  }
  poses_->keep(pose);
  return pose;
}

template <class AddSurface>
void PosedCharacterSkin::add_keys(BoundSpan span, SkinPose& pose, const AddSurface& add_surface) const {
  const auto add = [&](const PosedCages& cages, size_t i) {
    add_surface(cages.cages[i]);
    pose.transforms.push_back(cages.transforms[i]);
  };
  const bool with_ends = span == BoundSpan::kFrame && !pose_.frame_ends.cages.empty();
  const size_t count = pose_.shutter.cages.size() + (with_ends ? 2 : 0);
  pose.keys.reserve(count);
  pose.transforms.reserve(count);
  if (with_ends) add(pose_.frame_ends, 0);
  for (size_t i = 0; i < pose_.shutter.cages.size(); ++i) add(pose_.shutter, i);
  if (with_ends) add(pose_.frame_ends, 1);
  pose.open_key = with_ends ? 1 : 0;
  pose.close_key = pose.open_key + pose_.shutter.cages.size() - 1;
  pose.scale = pose_.scale;
  pose.length = pose_.length;
}

std::shared_ptr<const SkinPose> PosedCharacterSkin::make(BoundSpan span) const {
  auto made = std::make_shared<SkinPose>();
  add_keys(span, *made, [&](const std::vector<V3f>& cage) { made->keys.emplace_back(pose_.topology, cage); });
  if (pose_.push_out_view) {
    // The triangles are chosen for the shutter's keys, so that hair grows the same over either span.
    const size_t count = made->keys.size();
    TessellationOptions options;
    options.first_rated_key = count > pose_.shutter.cages.size() ? 1 : 0;
    options.end_rated_key = options.first_rated_key + pose_.shutter.cages.size();
    made->mesh = std::make_unique<const SkinMesh>(
        pelage::tessellate(made->keys, *pose_.push_out_view, options, Workers::alone()));
    for (size_t key = 0; key < count; ++key) made->trees.emplace_back(*made->mesh, static_cast<int>(key));
  }
  return made;
}

SkinPose PosedCharacterSkin::pose(BoundSpan span, std::span<const uint32_t> faces) const {
  SkinPose made;
  add_keys(span, made,
           [&](const std::vector<V3f>& cage) { made.keys.emplace_back(pose_.topology, cage, faces); });
  return made;
}

void PosedCharacterSkin::reserve_for_leaves(const Groom& groom, bool together) const {
  const size_t keys = pose_.shutter.cages.size() + pose_.frame_ends.cages.size();
  if (together) {
    poses_->reserve_for_whole(*pose_.topology, keys);
  } else {
    poses_->reserve_for_leaves(groom, *pose_.topology, keys);
  }
}

/// A whole temporary pose: not kept if making it again is cheaper than keeping it.
std::shared_ptr<const SkinPose> PosedCharacterSkin::temporary_pose() const {
  return pose_.push_out_view ? pose(BoundSpan::kShutter) : make(BoundSpan::kShutter);
}

template <class Visit>
void PosedCharacterSkin::visit_cages(BoundSpan span, const Visit& visit) const {
  for (const std::vector<V3f>& cage : pose_.shutter.cages) visit(cage);
  if (span != BoundSpan::kFrame) return;
  for (const std::vector<V3f>& cage : pose_.frame_ends.cages) visit(cage);
}

Box3f PosedCharacterSkin::bound(BoundSpan span) const {
  Box3f box;
  visit_cages(span, [&](const std::vector<V3f>& cage) {
    for (const V3f& point : cage) box.extendBy(point);
  });
  return widened(box);
}

Box3f PosedCharacterSkin::bound(const SkinPiece& piece, BoundSpan span) const {
  if (piece.is_whole()) return bound(span);
  const std::vector<uint32_t> vertices =
      vertices_of(*pose_.topology, faces_around(*pose_.topology, piece.faces));
  Box3f box;
  visit_cages(span, [&](const std::vector<V3f>& cage) {
    for (const uint32_t vertex : vertices) box.extendBy(cage[vertex]);
  });
  return widened(box);
}

std::vector<SkinPiece> PosedCharacterSkin::divide(const View& view, size_t max_cost, const Job& job) const {
  return divide_skin(temporary_pose()->keys, view, {}, max_cost, job);
}

SkinMesh PosedCharacterSkin::tessellate(const SkinPiece& piece, const View& view) const {
  if (piece.is_whole()) return pelage::tessellate(temporary_pose()->keys, view, {}, Workers::alone());
  if (pose_.push_out_view) return tessellate_faces(temporary_pose()->keys, piece.faces, view, {});
  const std::vector<uint32_t> around = faces_around(*pose_.topology, piece.faces);
  return tessellate_faces(pose(BoundSpan::kShutter, around).keys, piece.faces, view, {});
}

size_t PosedCharacterSkin::temporary_bytes(const SkinPiece& piece) const {
  const SurfaceTopology& topology = *pose_.topology;
  std::vector<uint32_t> around;
  if (!piece.is_whole()) around = faces_around(topology, piece.faces);
  const size_t faces = piece.is_whole() ? topology.face_count() : around.size();
  const size_t lattice = tessellating_bytes(topology, faces, piece.vertices);
  if (pose_.push_out_view) return lattice;
  const auto [held, making] = piece.is_whole() ? topology.pose_bytes() : topology.pose_bytes(around);
  return sizeof(SkinPose) + pose_.shutter.cages.size() * (held + sizeof(M44f)) + making + lattice;
}

std::optional<SurfaceStep> PosedCharacterSkin::step(const RootAddress* place) const {
  if (!pose_.motion) return {};
  const auto at = [&](size_t i) -> SurfacePoint {
    const M44f& m = pose_.motion->transforms[i];
    if (place && pose_.motion->poses) {
      const BlendedPose& pose = (*pose_.motion->poses)[i];
      return cage_point(*pose_.topology, place->face, place->u, place->v,
                        [&](uint32_t vertex) { return pose[vertex] * m; });
    }
    // The transform moves all points, so any point will do.
    return {V3f(m[3][0], m[3][1], m[3][2]), V3f(m[0][0], m[0][1], m[0][2]), V3f(m[1][0], m[1][1], m[1][2])};
  };
  return SurfaceStep{at(0), at(1)};
}

std::optional<V3f> PosedCharacterSkin::normal(const RootAddress& place) const {
  const std::vector<V3f>& cage = pose_.shutter.cages.front();
  const SurfacePoint point = cage_point(*pose_.topology, place.face, place.u, place.v,
                                        [&](uint32_t vertex) { return cage[vertex]; });
  return LimitSurface::frame_of(point).normal;
}

size_t PosedCharacterSkin::bytes() const {
  return sizeof(*this) + cage_bytes(pose_.shutter) + cage_bytes(pose_.frame_ends);
}

}  // namespace pelage
