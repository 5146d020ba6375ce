// SPDX-License-Identifier: Apache-2.0
#include "rib/host/hair_session.h"

#include <algorithm>
#include <iterator>

#include "base/memory_budget.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr size_t kFramesKept = 4;
constexpr size_t kTreesKept = 64;  // of one frame

SceneDescription load(const HairArguments& arguments) {
  RibUse use;
  use.overrides = true;
  SceneDescription scene = load_scene(arguments.scene, arguments.overrides, use);
  scene.lights.items.clear();  // the host has its own
  return scene;
}

}  // namespace

std::shared_ptr<const CoatTree> HairFrame::tree(size_t coat, const HairDetail& detail,
                                                const Workers& workers) const {
  const std::lock_guard lock(mutex_);
  const std::pair key(coat, detail);
  for (const auto& [known, tree] : trees_) {
    if (known == key) return tree;
  }
  const FrameCoat& of = parts_.coats[coat];
  std::optional<Simplification> lod;
  if (detail.kind == HairDetail::Kind::kSceneCamera) lod = of.lod;
  if (detail.kind == HairDetail::Kind::kScale)
    lod.emplace(scale_detail(of, lod_, detail.pixels_per_unit, workers));
  trees_.emplace_back(key, std::make_shared<const CoatTree>(of, lod));
  const auto made = trees_.back().second;
  if (trees_.size() > std::max(kTreesKept, 2 * parts_.coats.size())) trees_.pop_front();
  return made;
}

HairSession::HairSession(const HairArguments& arguments)
    : scene_(load(arguments)), workers_(arguments.threads), assets_(load_assets(scene_, job())) {}

std::shared_ptr<const HairFrame> HairSession::frame(int frame, const std::string& character) const {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const HairFrame> found = frames_[{frame, character}].lock();
  if (!found) {
    std::set<std::string> only;
    if (!character.empty()) only.insert(character);
    FrameParts parts = pose_frame(scene_, *assets_, frame, job(), only);
    if (!character.empty() && parts.skins.empty()) {
      throw Error(ErrorKind::kArguments, "procedural: there is no character " + quote(character) +
                                             suggest(character, scene_.characters.names()));
    }
    found = std::make_shared<const HairFrame>(std::move(parts), scene_.render.lod);
    std::erase_if(frames_, [](const auto& entry) { return entry.second.expired(); });
    frames_[{frame, character}] = found;
  }
  if (recent_.empty() || recent_.back() != found) {
    std::erase(recent_, found);
    recent_.push_back(found);
    if (recent_.size() > kFramesKept) recent_.pop_front();
  }
  return found;
}

std::shared_ptr<const CoatTree> HairSession::tree(const HairFrame& frame, size_t coat,
                                                  const HairDetail& detail) const {
  const std::lock_guard lock(mutex_);
  return frame.tree(coat, detail, workers_);
}

Box3f HairSession::box(const CoatTree& tree, LeafRange range) const {
  const std::lock_guard lock(mutex_);
  return tree.box(range, job());
}

Strands HairSession::grow(const CoatTree& tree, size_t leaf) const {
  const int64_t bytes = tree.growth_bytes(leaf);
  std::unique_lock lock(growth_);
  grown_.wait(lock, [&] { return growing_ == 0 || has_room(ledger_, bytes); });
  MemoryCharge charge = reserve(ledger_, MemoryTag::kChunks, bytes, "growing a leaf of a coat");
  ++growing_;
  lock.unlock();
  const auto end = [&] {
    lock.lock();
    charge = {};
    --growing_;
    grown_.notify_all();
  };
  try {
    Strands strands = tree.grow(leaf);
    end();
    return strands;
  } catch (...) {
    end();
    throw;
  }
}

std::shared_ptr<const HairSession> HairSessions::of(const HairArguments& arguments) {
  HairArguments key;  // only the arguments that select the scene
  key.scene = arguments.scene;
  key.overrides = arguments.overrides;
  key.threads = arguments.threads;
  const std::lock_guard lock(mutex_);
  std::weak_ptr<const HairSession>& known = open_[print_hair_arguments(key)];
  std::shared_ptr<const HairSession> session = known.lock();
  if (!session) {
    last_.reset();  // two scenes need not fit into memory together
    known = session = std::make_shared<const HairSession>(arguments);
  }
  last_ = session;
  return session;
}

}  // namespace pelage
