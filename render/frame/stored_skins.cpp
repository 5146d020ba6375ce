// SPDX-License-Identifier: Apache-2.0
#include "render/frame/stored_skins.h"

#include <algorithm>
#include <span>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "base/program_identity.h"

namespace pelage {
namespace {

const std::string kSkinsKind = "skins";
enum Section : size_t { kPieces, kFaces, kMeshes };
enum MeshSection : size_t {
  kPositions,
  kNormals,
  kTriangles,
  kTriangleFaces,
  kUv,
  kMeshSections
};                                                // of a piece
constexpr size_t kVertexBytes = 2 * sizeof(V3f);  // at each motion key
constexpr size_t kTriangleBytes = 3 * sizeof(uint32_t) + sizeof(uint32_t) + 3 * sizeof(V2f);

struct StoredPiece {
  uint32_t skin, faces;
  uint64_t vertices, triangles, temporary_bytes;
};

size_t mesh_bytes(const SkinPiece& piece, int motion_keys) {
  return piece.vertices * static_cast<size_t>(motion_keys) * kVertexBytes + piece.triangles * kTriangleBytes;
}

[[noreturn]] void refuse(const StoredSections& file) {
  throw Error(ErrorKind::kInput, {file.path().string(), 0, 0}, "damaged skins");
}

template <class T>
std::vector<T> values(const StoredSections& file, size_t section) {
  if (file.section_bytes(section) % sizeof(T) != 0) refuse(file);
  std::vector<T> result(file.section_bytes(section) / sizeof(T));
  file.read(section, std::as_writable_bytes(std::span(result)));
  return result;
}

}  // namespace

std::optional<ContentHash> StoredSkins::key(const RenderScene& scene, size_t max_cost) {
  const View view = scene.camera.view();
  ContentHasher hasher;
  hasher.add("skins").add(kVersion).add(arithmetic_identity()).add(static_cast<uint64_t>(max_cost));
  hasher.add(view.position.x).add(view.position.y).add(view.position.z);
  hasher.add(view.focal_pixels).add(view.near_distance);
  for (const SkinPart& part : scene.skins) {
    const std::optional<ContentHash> content = part.skin->content();
    if (!content) return {};
    hasher.add(*content).add(part.skin->motion_keys());
  }
  return hasher.digest();
}

std::unique_ptr<const StoredSkins> StoredSkins::open(const ContentStore& store, const ContentHash& key,
                                                     const RenderScene& scene, const WarningSink& warn) {
  std::optional<StoredSections> file = store.open_sections(kSkinsKind, key, warn);
  if (!file) return nullptr;
  try {
    return std::make_unique<const StoredSkins>(std::move(*file), scene, warn);
  } catch (const Error& error) {
    warn(std::string(error.what()) + "; they are made again");
    return nullptr;
  }
}

StoredSkins::StoredSkins(StoredSections file, const RenderScene& scene, WarningSink warn)
    : file_(std::move(file)), warn_(std::move(warn)) {
  for (const SkinPart& part : scene.skins) {
    face_counts_.push_back(part.skin->face_count());
    motion_keys_.push_back(part.skin->motion_keys());
  }
  if (file_.section_count() < kMeshes) refuse(file_);
  const auto stored = values<StoredPiece>(file_, kPieces);
  const auto faces = values<uint32_t>(file_, kFaces);
  if (file_.section_count() != kMeshes + kMeshSections * stored.size()) refuse(file_);
  size_t used = 0;
  for (size_t i = 0; i < stored.size(); ++i) {
    const StoredPiece& s = stored[i];
    // Pieces of a skin are adjacent, and every skin has one.
    const uint32_t previous = i == 0 ? 0 : stored[i - 1].skin;
    if (s.skin >= scene.skins.size() || (i == 0 ? s.skin != 0 : s.skin != previous && s.skin != previous + 1))
      refuse(file_);
    constexpr uint64_t kMax = uint64_t(1) << 31;
    if (s.faces > faces.size() - used || s.vertices >= kMax || s.triangles >= kMax) refuse(file_);
    SkinChunk& chunk = pieces_.emplace_back();
    const auto first = faces.begin() + static_cast<std::ptrdiff_t>(used);
    chunk.skin = s.skin;
    chunk.piece = {{first, first + s.faces}, s.vertices, s.triangles};
    chunk.temporary_bytes = s.temporary_bytes;
    used += s.faces;
    const std::vector<uint32_t>& own = chunk.piece.faces;
    if (!std::is_sorted(own.begin(), own.end()) || (!own.empty() && own.back() >= face_counts_[s.skin]))
      refuse(file_);
    const size_t points = s.vertices * static_cast<size_t>(motion_keys_[s.skin]) * sizeof(V3f);
    const size_t expected[kMeshSections] = {points, points, s.triangles * 3 * sizeof(uint32_t),
                                            s.triangles * sizeof(uint32_t), s.triangles * 3 * sizeof(V2f)};
    for (size_t section = 0; section < kMeshSections; ++section) {
      if (file_.section_bytes(kMeshes + kMeshSections * i + section) != expected[section]) refuse(file_);
    }
  }
  if (pieces_.empty() || pieces_.back().skin + 1 != scene.skins.size() || used != faces.size()) refuse(file_);
}

SkinMesh StoredSkins::read(size_t piece) const {
  const SkinChunk& chunk = pieces_[piece];
  const size_t first = kMeshes + kMeshSections * piece;
  SkinMesh mesh;
  mesh.motion_keys = motion_keys_[chunk.skin];
  mesh.positions = values<float>(file_, first + kPositions);
  mesh.normals = values<float>(file_, first + kNormals);
  mesh.triangles = values<uint32_t>(file_, first + kTriangles);
  mesh.faces = values<uint32_t>(file_, first + kTriangleFaces);
  mesh.vertex_uv = values<V2f>(file_, first + kUv);
  const auto below = [](const std::vector<uint32_t>& numbers, size_t count) {
    return std::all_of(numbers.begin(), numbers.end(), [count](uint32_t n) { return n < count; });
  };
  if (!below(mesh.triangles, chunk.piece.vertices) || !below(mesh.faces, face_counts_[chunk.skin]))
    refuse(file_);
  return mesh;
}

std::optional<SkinMesh> StoredSkins::mesh(size_t piece) const {
  if (is_damaged_) return {};
  try {
    return read(piece);
  } catch (const Error& error) {
    if (is_damaged_.exchange(true)) return {};
    std::error_code why;
    std::filesystem::remove(file_.path(), why);
    warn_(std::string(error.what()) + "; skins are tessellated instead" +
          (why ? "; the file cannot be deleted: " + why.message() : ", and the next run makes it again"));
    return {};
  }
}

size_t StoredSkins::bytes() const {
  size_t sum = sizeof(*this) + file_.bytes() + pieces_.capacity() * sizeof(pieces_[0]);
  for (const SkinChunk& chunk : pieces_) sum += chunk.piece.faces.capacity() * sizeof(uint32_t);
  return sum;
}

bool StoredSkins::write(const ContentStore& store, const ContentHash& key, const RenderScene& scene,
                        const std::vector<SkinChunk>& pieces, const Job& job) {
  std::vector<StoredPiece> stored;
  std::vector<uint32_t> faces;
  for (const SkinChunk& chunk : pieces) {
    const SkinPiece& piece = chunk.piece;
    stored.push_back({chunk.skin, static_cast<uint32_t>(piece.faces.size()), piece.vertices, piece.triangles,
                      chunk.temporary_bytes});
    faces.insert(faces.end(), piece.faces.begin(), piece.faces.end());
  }
  ContentStore::Writer writer = store.writer(kSkinsKind, key);
  writer.add(std::span<const StoredPiece>(stored));
  writer.add(std::span<const uint32_t>(faces));
  for (size_t next = 0; next < pieces.size() && !job.progress.cancelled() && !writer.failed();) {
    // As many as threads and memory allow.
    std::vector<MemoryCharge> charges;
    while (next + charges.size() < pieces.size() &&
           charges.size() < static_cast<size_t>(job.workers.thread_count())) {
      const SkinChunk& chunk = pieces[next + charges.size()];
      const int keys = scene.skins[chunk.skin].skin->motion_keys();
      const auto bytes = static_cast<int64_t>(chunk.temporary_bytes + mesh_bytes(chunk.piece, keys));
      if (!has_room(job.ledger, bytes)) break;
      charges.emplace_back(job.ledger, MemoryTag::kChunks, bytes);
    }
    if (charges.empty()) return false;
    std::vector<SkinMesh> made(charges.size());
    job.workers.for_each(made.size(), 1, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) {
        const SkinChunk& chunk = pieces[next + i];
        made[i] = scene.skins[chunk.skin].skin->tessellate(chunk.piece, scene.camera.view());
      }
    });
    for (const SkinMesh& mesh : made) {
      writer.add(std::span<const float>(mesh.positions));
      writer.add(std::span<const float>(mesh.normals));
      writer.add(std::span<const uint32_t>(mesh.triangles));
      writer.add(std::span<const uint32_t>(mesh.faces));
      writer.add(std::span<const V2f>(mesh.vertex_uv));
    }
    next += made.size();
  }
  if (job.progress.cancelled()) return false;
  return writer.commit([&](const std::string& line) { job.progress.warn(line); });
}

}  // namespace pelage
