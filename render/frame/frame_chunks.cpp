// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_chunks.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "render/accel/embree_chunk.h"
#include "render/accel/fur_chunk.h"
#include "render/frame/strand_fields.h"

namespace pelage {
namespace {

/// Temporary memory of growing: a block of strands during the operators, whose points and colours are rows of
/// floats, and as much again for operators or reading a file; more when they are posed at several times.
constexpr size_t kGrowthBytes = size_t(128) << 10, kGrowthBytesPerPoint = size_t(7) << 10;
/// Max cost of a piece of skin, in triangles of about 250 bytes each: 1/256 of the budget, so that small
/// budgets can hold many; but no less than a leaf of some hundred strands needs, because every piece poses
/// the faces around it too.
size_t max_piece_cost(uint64_t memory_limit) {
  constexpr uint64_t kMin = 4096, kMax = 65536;
  return memory_limit == 0 ? kMax : std::clamp<uint64_t>(memory_limit >> 16, kMin, kMax);
}

/// Dividing a skin of at least this size is worth all threads: about 0.05 s on one.
constexpr size_t kLargeSkin = size_t(16) << 20;

size_t growth_bytes(const StrandCounts& n) {
  if (n.strands == 0) return kGrowthBytes;
  const size_t points = std::max(n.longest, n.points / n.strands + 1);
  return kGrowthBytes + 2 * kGrowthBytesPerPoint * points * (n.motion_keys > 1 ? 2 : 1);
}

const FibreParams& fibre_material(const RenderScene& scene, const FurPart& part) {
  const FibreParams* fibre = fibre_params(scene.materials[part.material]);
  if (!fibre) throw Error(ErrorKind::kInput, part.name + ": its material is not for strands");
  return *fibre;
}

}  // namespace

FrameChunks::FrameChunks(const RenderScene& scene, const Job& job)
    : scene_(scene), bounds_(scene.render.bounds) {
  for (uint32_t part = 0; part < scene.fur.size(); ++part) {
    fibre_material(scene, scene.fur[part]);
    for (const auto& procedural : scene.fur[part].procedurals) {
      collect(*procedural, part, static_cast<uint32_t>(scales_.size()));
      scales_.push_back(procedural->scale());
    }
  }
  was_grown_ = std::make_unique<std::atomic<bool>[]>(leaves_.size());
  growths_ = std::make_unique<std::atomic<uint32_t>[]>(leaves_.size());
  divide_skins(job);
}

void FrameChunks::store_skins(const Job& job) {
  const std::string& folder = scene_.render.bvh.file.path;
  if (folder.empty() || stored_skins_ || pieces_.empty()) return;
  const std::optional<ContentHash> key = StoredSkins::key(scene_, max_piece_cost(scene_.render.memory.bytes));
  if (!key) return;
  const ContentStore store(folder);
  const ContentStore::Lock lock = store.lock("skins", *key, [&] { return job.progress.cancelled(); });
  // The previous holder of the lock may have written them.
  if (lock.held()) stored_skins_ = StoredSkins::open(store, *key, scene_, [](const std::string&) {});
  if (!stored_skins_) {
    StoredSkins::write(store, *key, scene_, pieces_, job);
  } else {
    pieces_ = {};  // equal ones
  }
}

void FrameChunks::divide_skins(const Job& job) {
  std::vector<size_t> making(scene_.skins.size());
  for (size_t i = 0; i < making.size(); ++i) making[i] = scene_.skins[i].skin->temporary_bytes({});
  if (making.empty()) return;
  if (const std::string& folder = scene_.render.bvh.file.path; !folder.empty()) {
    const std::optional<ContentHash> key =
        StoredSkins::key(scene_, max_piece_cost(scene_.render.memory.bytes));
    const WarningSink warn = [&progress = job.progress](const std::string& line) { progress.warn(line); };
    if (key) stored_skins_ = StoredSkins::open(ContentStore(folder), *key, scene_, warn);
    if (stored_skins_) return;
  }
  const auto max = static_cast<size_t>(std::max_element(making.begin(), making.end()) - making.begin());
  const size_t largest = making[max];
  const uint64_t limit = scene_.render.memory.bytes;
  require_memory(job.ledger, static_cast<int64_t>(largest),
                 "tessellating the skin of " + scene_.skins[max].name);
  const size_t concurrency = std::min(static_cast<size_t>(job.workers.thread_count()), making.size());
  const bool fit = limit == 0 || job.ledger.budgeted() + static_cast<int64_t>(concurrency * largest) <=
                                     static_cast<int64_t>(limit);
  const MemoryCharge passing(job.ledger, MemoryTag::kChunks,
                             static_cast<int64_t>(fit ? concurrency * largest : largest));
  const size_t max_cost = max_piece_cost(limit);
  std::vector<std::vector<SkinChunk>> pieces(making.size());
  const auto divide = [&](size_t i, const Workers& workers) {
    const DeferredSkin& skin = *scene_.skins[i].skin;
    for (SkinPiece& piece : skin.divide(scene_.camera.view(), max_cost, {workers, job.ledger, job.progress}))
      pieces[i].push_back({static_cast<uint32_t>(i), std::move(piece), 0});
    Job{workers, job.ledger, job.progress}.for_each(pieces[i].size(), 1, [&](WorkRange range) {
      for (size_t k = range.begin; k < range.end; ++k)
        pieces[i][k].temporary_bytes = skin.temporary_bytes(pieces[i][k].piece);
    });
  };
  // Large skins one after the other, each with all threads; the others concurrently.
  const auto is_large = [&](size_t i) { return !fit || making[i] > kLargeSkin; };
  for (size_t i = 0; i < making.size(); ++i) {
    if (is_large(i)) divide(i, job.workers);
  }
  job.for_each(making.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      if (!is_large(i)) divide(i, Workers::alone());
    }
  });
  for (auto& of_skin : pieces) {
    for (SkinChunk& piece : of_skin) pieces_.push_back(std::move(piece));
  }
}

void FrameChunks::collect(const Procedural& procedural, uint32_t part, uint32_t coat) {
  std::vector<std::unique_ptr<Procedural>> children = procedural.split();
  if (children.empty()) {
    leaves_.push_back(&procedural);
    parts_.push_back(part);
    coats_.push_back(coat);
  }
  for (std::unique_ptr<Procedural>& child : children) {
    made_.push_back(std::move(child));
    collect(*made_.back(), part, coat);
  }
}

ChunkContents FrameChunks::grow(uint32_t chunk) const {
  if (is_skin(chunk)) {
    const size_t number = chunk - leaves_.size();
    const SkinChunk& piece = pieces()[number];
    if (std::optional<SkinMesh> mesh = stored_skins_ ? stored_skins_->mesh(number) : std::nullopt)
      return {std::move(*mesh), piece.skin};
    return {scene_.skins[piece.skin].skin->tessellate(piece.piece, scene_.camera.view()), piece.skin};
  }
  const FurPart& part = scene_.fur[parts_[chunk]];
  const FibreParams& fibre = fibre_material(scene_, part);
  FurContents fur;
  fur.strands = leaves_[chunk]->generate();
  const auto count = static_cast<int64_t>(fur.strands.strand_count());
  strands_grown_.fetch_add(count, std::memory_order_relaxed);
  growths_[chunk].fetch_add(1, std::memory_order_relaxed);
  if (was_grown_[chunk].exchange(true, std::memory_order_relaxed))
    strands_regrown_.fetch_add(count, std::memory_order_relaxed);
  if (fur.strands.strand_count() > 0) {
    find_attributes(fibre.color, fur.strands, part.name);  // throws if one is missing
    fur.opacity = point_opacities(fibre.opacity, fur.strands, part);
  }
  return {std::move(fur), parts_[chunk]};
}

ChunkCounts FrameChunks::counts(uint32_t chunk) const {
  ChunkCounts counts;
  if (is_skin(chunk)) {
    const SkinChunk& piece = pieces()[chunk - leaves_.size()];
    counts.vertices = piece.piece.vertices;
    counts.triangles = piece.piece.triangles;
    counts.motion_keys = scene_.skins[piece.skin].skin->motion_keys();
    counts.growth_bytes = piece.temporary_bytes;
    return counts;
  }
  const StrandCounts strands = leaves_[chunk]->counts();
  counts.strands = strands.strands;
  counts.points = strands.points;
  counts.segments = strands.segments;
  counts.attribute_floats = strands.attribute_floats;
  counts.motion_keys = static_cast<int>(strands.motion_keys);
  counts.growth_bytes = growth_bytes(strands) + leaves_[chunk]->temporary_bytes();
  return counts;
}

StrandScale FrameChunks::scale(uint32_t chunk) const {
  return is_skin(chunk) ? StrandScale{} : scales_[coats_[chunk]];
}

std::string FrameChunks::name(uint32_t chunk) const {
  return is_skin(chunk) ? scene_.skins[pieces()[chunk - leaves_.size()].skin].name
                        : scene_.fur[parts_[chunk]].name;
}

bool FrameChunks::opaque() const {
  return std::all_of(scene_.fur.begin(), scene_.fur.end(),
                     [&](const FurPart& part) { return is_opaque(fibre_material(scene_, part).opacity); });
}

bool FrameChunks::in_fur_trees() const {
  return pelage::in_fur_trees(scene_.render.accel, scene_.render.curves);
}

size_t FrameChunks::bytes() const {
  constexpr size_t kHeap = 16;  // per block: overhead and rounding of the heap
  size_t sum = sizeof(*this) + made_.capacity() * sizeof(made_[0]) + leaves_.capacity() * sizeof(leaves_[0]) +
               (parts_.capacity() + coats_.capacity()) * sizeof(uint32_t) +
               scales_.capacity() * sizeof(scales_[0]) + pieces_.capacity() * sizeof(pieces_[0]) +
               leaves_.size() * (sizeof(was_grown_[0]) + sizeof(growths_[0]));
  if (stored_skins_) sum += stored_skins_->bytes();
  for (const auto& procedural : made_) sum += procedural->bytes() + kHeap;
  for (const SkinChunk& piece : pieces_) sum += piece.piece.faces.capacity() * sizeof(uint32_t) + kHeap;
  return sum;
}

FrameChunks::MeasurePlan FrameChunks::measure_plan(const Job& job) const {
  // The strands of a leaf are charged where they are measured; the block during the operators is charged
  // here.
  MeasurePlan plan;
  // A chunk that is grown again for a ray also needs memory for its tree: the message includes it.
  const bool read = !scene_.render.bvh.file.path.empty();
  uint32_t which = 0;
  size_t strands = 0, largest = 0;
  for (uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    const ChunkCounts n = counts(leaf);
    const size_t own = measuring_bytes(leaves_[leaf]->counts());
    const size_t chunk = read             ? 0
                         : in_fur_trees() ? FurChunk::bytes_bound(n, FurChunkOptions())
                                          : EmbreeChunk::bytes_bound(n);
    if (const size_t whole = std::max(chunk, n.growth_bytes + own); whole > largest) {
      largest = whole;
      which = leaf;
    }
    plan.block = std::max(plan.block, n.growth_bytes);
    strands = std::max(strands, own);
  }
  if (leaves_.empty()) return plan;
  const auto one = static_cast<int64_t>(plan.block + strands);
  require_memory(job.ledger, std::max(one, static_cast<int64_t>(largest)),
                 "growing the largest chunk of " + scene_.fur[parts_[which]].name);
  plan.concurrency = job.workers.thread_count();
  if (job.ledger.limit() > 0) {
    plan.concurrency = static_cast<int>(std::clamp<int64_t>(
        (job.ledger.limit() - job.ledger.budgeted()) / std::max<int64_t>(1, one), 1, plan.concurrency));
  }
  return plan;
}

bool FrameChunks::measures_boxes_of_fur_trees() const {
  if (!in_fur_trees() || !measures_strands(bounds_) || bound_keys(bounds_) != 1) return false;
  return std::none_of(leaves_.begin(), leaves_.end(),
                      [](const Procedural* leaf) { return leaf->bounds_record().has_value(); });
}

int64_t FrameChunks::bytes_bound(size_t chunks) const {
  int64_t sum = 0;
  for (uint32_t chunk = 0; chunk < chunks; ++chunk) {
    const ChunkCounts n = counts(chunk);
    sum +=
        static_cast<int64_t>(!is_skin(chunk) && in_fur_trees() ? FurChunk::bytes_bound(n, FurChunkOptions())
                                                               : EmbreeChunk::bytes_bound(n));
  }
  return sum;
}

bool FrameChunks::bound_quickly(const Job& job) {
  if (!measures_boxes_of_fur_trees()) return false;
  if (!has_room(job.ledger, bytes_bound(leaves_.size()))) return false;
  bounds_ = BoundingStrategy::kConservative;
  return true;
}

bool FrameChunks::grow_at_once(const Job& job) {
  if (bounds_ != BoundingStrategy::kExact || job.ledger.limit() == 0 || !measures_boxes_of_fur_trees())
    return false;
  // As much memory again stays free for what is made after the chunks.
  if (!has_room(job.ledger, 2 * bytes_bound(size()))) return false;
  bounds_ = BoundingStrategy::kNone;
  return true;
}

std::optional<ContentHash> FrameChunks::content(uint32_t leaf) const {
  const RenderParams& render = scene_.render;
  const std::optional<ContentHash> strands = leaves_[leaf]->content();
  // Boxes that are linear in time are not kept (ChunkBoxes::take_given()).
  if (!strands || !in_fur_trees() || bound_keys(render.bounds) != 1) return {};
  const FibreParams& fibre = fibre_material(scene_, scene_.fur[parts_[leaf]]);
  if (!is_opaque(fibre.opacity) && (!fibre.opacity.files().empty() || fibre.opacity.dependence().face))
    return {};  // the text names only files
  const StrandScale scale = this->scale(leaf);
  ContentHasher hasher;
  hasher.add("chunk of fur").add(*strands).add(ValueReader<Field>::print(fibre.opacity));
  hasher.add(scale.width).add(scale.anchor.x).add(scale.anchor.y).add(scale.anchor.z).add(scale.widest);
  hasher.add(render.compact_attributes);
  for (const std::string& attribute : fibre.color.attribute_names())
    hasher.add(attribute);  // checked in grow()
  return hasher.digest();
}

std::vector<ChunkBounds> FrameChunks::leaf_bounds(const std::vector<const Procedural*>& leaves,
                                                  const Job& job, BoundingCounts& counts) const {
  BoundingOptions options;
  options.strategy = bounds_;
  options.in_one_part = in_fur_trees();
  std::optional<Workers> fewer;
  MemoryCharge blocks;
  if (measures_strands(options.strategy)) {
    const MeasurePlan measure_plan = this->measure_plan(job);
    blocks = MemoryCharge(job.ledger, MemoryTag::kChunks,
                          static_cast<int64_t>(measure_plan.block) * measure_plan.concurrency);
    if (measure_plan.concurrency < job.workers.thread_count()) fewer.emplace(measure_plan.concurrency);
  }
  return bound_chunks(options, leaves, {fewer ? *fewer : job.workers, job.ledger, job.progress}, &counts);
}

std::vector<ChunkBounds> FrameChunks::bounds(const Job& job, BoundingCounts& counts,
                                             const std::vector<const ChunkBounds*>& known) const {
  std::vector<ChunkBounds> bounds(size());
  std::vector<const Procedural*> unknown;
  std::vector<uint32_t> numbers;
  for (uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    if (!known.empty() && known[leaf]) {
      bounds[leaf] = *known[leaf];
      counts.area += area_of(bounds[leaf]);
    } else {
      unknown.push_back(leaves_[leaf]);
      numbers.push_back(leaf);
    }
  }
  std::vector<ChunkBounds> measured = leaf_bounds(unknown, job, counts);
  for (size_t i = 0; i < measured.size(); ++i) bounds[numbers[i]] = std::move(measured[i]);
  const BoundingStrategy strategy = bounds_;
  job.workers.for_each(pieces().size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end && !job.progress.cancelled(); ++i) {
      const SkinChunk& piece = pieces()[i];
      ChunkBounds& box = bounds[leaves_.size() + i];
      box.keys = bound_keys(strategy);
      box.boxes.assign(static_cast<size_t>(box.keys),
                       scene_.skins[piece.skin].skin->bound(piece.piece, bound_span(strategy)));
    }
  });
  return bounds;
}

}  // namespace pelage
