// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <iostream>
#include <map>
#include <set>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/heap.h"
#include "base/memory_budget.h"
#include "base/nearest_name.h"
#include "cli/commands.h"
#include "cli/output_files.h"
#include "cli/read_scene.h"
#include "cli/run.h"
#include "cli/unworn_grooms.h"
#include "geom/io/strand_file.h"
#include "geom/strand_merge.h"
#include "groom/cache/cache_report.h"
#include "procedurals/bounds/bounding.h"
#include "render/frame/frame_chunks.h"
#include "world/assets.h"
#include "world/compose.h"
#include "world/frames.h"
#include "world/motion_files.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

/// Computes the boxes of chunks before rendering, so that a later render reads them instead of growing all
/// fur for them. The boxes are stored in files beside the caches of the grooms.
///
/// For every frame of the scene, reads the stored boxes, grows the chunks whose boxes are missing, stores the
/// new boxes, and reports on standard output. Skips coats without a cache. Does nothing if the bounding
/// strategy of the scene does not measure strands. Boxes depend on the level of detail: the boxes are those
/// for the detail that the scene requests. Returns false when cancelled.
bool grow_boxes(const SceneDescription& scene, Assets& assets, Run& run) {
  const BoundingOptions bounding{.strategy = scene.render.bounds};
  if (!measures_strands(bounding.strategy)) return true;
  for (const int frame : scene.frames.frames) {
    const double began = run.seconds();
    const World world = run.stage("pose", [&] { return compose(scene, assets, frame, run.job()); });
    const FrameChunks chunks(world.scene, run.job());
    std::vector<const Procedural*> remembering;
    for (const Procedural* leaf : chunks.leaves()) {
      if (leaf->bounds_record()) remembering.push_back(leaf);
    }
    if (remembering.empty()) continue;
    const bool reduced = std::any_of(world.scene.fur.begin(), world.scene.fur.end(),
                                     [](const FurPart& part) { return part.lod.has_value(); });
    BoundingCounts counts;
    bound_chunks(bounding, remembering, run.job(), &counts);
    if (run.display().cancelled()) return false;
    const double seconds = run.seconds() - began;
    run.statistics().stages_s["bound"] += seconds;
    std::cout << fmt::format("frame {}: boxes of {} chunks{}, {} read from the cache, {:.2f} s\n", frame,
                             remembering.size(), reduced ? " at reduced detail" : "", counts.remembered,
                             seconds);
  }
  return true;
}

struct Growth {
  std::vector<Strands> leaves;
  double seconds = 0;
  size_t strands = 0, points = 0, bytes = 0;
  MemoryCharge charge;
};

/// A strand file holds one moment: the opening of the shutter. Also, parts that move have more motion keys.
Strands at_open(Strands strands) {
  if (strands.motion_keys() == 1) return strands;
  const size_t points = strands.point_count();
  StrandArrays arrays = std::move(strands).release();
  arrays.motion_keys = 1;
  arrays.points.resize(4 * points);
  return Strands(std::move(arrays));
}

int64_t bytes_of(const StrandCounts& n) {
  const size_t floats = n.points * n.motion_keys * 4 + n.attribute_floats;
  return static_cast<int64_t>(floats * sizeof(float) + n.strands * (sizeof(uint64_t) + sizeof(uint32_t) +
                                                                    sizeof(RootAddress) + sizeof(V2f)));
}

// All leaves of one coat, grown in parallel; kept only for writing, which needs twice their memory.
Growth grow(const FurPart& part, bool keep, Run& run) {
  std::vector<std::unique_ptr<Procedural>> leaves;
  for (const auto& procedural : part.procedurals) {
    for (auto& leaf : procedural->split()) leaves.push_back(std::move(leaf));
  }
  Growth growth;
  if (keep) {
    int64_t bytes = 0;
    for (const auto& leaf : leaves) bytes += 2 * bytes_of(leaf->counts());
    growth.charge = reserve(run.ledger(), MemoryTag::kChunks, bytes,
                            "growing the strands of " + part.name + " for the output file");
  }
  growth.leaves.resize(leaves.size());
  std::atomic<size_t> strands = 0, points = 0, bytes = 0;
  const double began = run.seconds();
  run.display().begin("grow " + part.name, static_cast<double>(leaves.size()));
  run.workers().for_each(leaves.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end && !run.display().cancelled(); ++i) {
      Strands leaf = leaves[i]->generate();
      strands += leaf.strand_count();
      points += leaf.point_count();
      bytes += leaf.bytes();
      if (keep) growth.leaves[i] = at_open(std::move(leaf));
      run.display().advance(1);
    }
  });
  run.display().end();
  growth.seconds = run.seconds() - began;
  growth.strands = strands;
  growth.points = points;
  growth.bytes = bytes;
  return growth;
}

void report(const std::string& name, const Growth& growth, int threads) {
  const double rate = growth.seconds > 0 ? static_cast<double>(growth.strands) / growth.seconds : 0;
  std::cout << fmt::format(
      "{}: {} strands, {} points, {:.1f} MiB ({:.0f} bytes per strand), {:.0f} strands/s on {}\n", name,
      growth.strands, growth.points, static_cast<double>(growth.bytes) / (1 << 20),
      growth.strands ? static_cast<double>(growth.bytes) / static_cast<double>(growth.strands) : 0.0, rate,
      counted(threads, "thread"));
}

void report_cache(const std::string& name, const GroomCacheReport& cache, bool explain) {
  const auto strands = static_cast<double>(std::max<size_t>(1, cache.strands));
  std::cout << fmt::format("{}: {}; {} strands, {:.1f} bytes per strand, {:.2f} s{}\n", name, cache.summary(),
                           cache.strands,
                           static_cast<double>(cache.offset_bytes + cache.follicle_bytes) / strands,
                           cache.seconds, cache.stored ? "" : ", not stored");
  if (!explain) return;
  for (const GroomCacheReport::Stage& stage : cache.stages) {
    std::cout << fmt::format("  {:<12} {}{}\n", stage.name, stage.fresh ? "fresh" : "stale: ", stage.reason);
  }
  std::cout << fmt::format("  {}\n", cache.file.string());
}

// Keeps only the current files of the scene's grooms in each cache folder, and no files in the user's cache.
void prune_caches(const Assets& assets, const GrowthCache* growth_cache) {
  std::map<std::filesystem::path, std::vector<std::filesystem::path>> folders;
  for (const auto& [name, groom] : assets.grooms) {
    if (!groom->cache_report()) continue;
    const auto& files = groom->cache_report()->files;
    std::vector<std::filesystem::path>& keep = folders[groom->store()->folder()];
    keep.insert(keep.end(), files.begin(), files.end());
  }
  const auto tell = [](const std::filesystem::path& folder, const ContentStore::Removed& removed) {
    std::cout << fmt::format("{}: {} removed, {:.1f} MiB\n", folder.string(),
                             counted(static_cast<int64_t>(removed.files), "file"),
                             static_cast<double>(removed.bytes) / (1 << 20));
  };
  for (const auto& [folder, keep] : folders)
    tell(folder, ContentStore(folder).prune(std::chrono::hours(1), keep));
  if (growth_cache) tell(growth_cache->folder(), growth_cache->clear());
}

/// For messages: the coats of which no strand has an attribute that strands of another coat have. `coats`:
/// the coat of each batch.
std::map<std::string, std::string> coats_without(const std::vector<Strands>& grown,
                                                 const std::vector<std::string>& coats) {
  std::map<std::string, std::set<std::string>> owners;
  for (size_t i = 0; i < grown.size(); ++i) {
    for (const StrandAttribute& attribute : grown[i].attributes()) owners[attribute.name].insert(coats[i]);
  }
  std::map<std::string, std::string> without;
  for (const auto& [attribute, with] : owners) {
    for (const std::string& coat : std::set<std::string>(coats.begin(), coats.end())) {
      if (with.contains(coat)) continue;
      std::string& text = without[attribute];
      text += (text.empty() ? "" : ", ") + coat;
    }
  }
  return without;
}

/// `coats`: the coat of each batch.
void write_grown(const std::string& path, const std::vector<Strands>& grown,
                 const std::vector<std::string>& coats, Progress& progress) {
  if (std::all_of(grown.begin(), grown.end(), [](const Strands& s) { return s.strand_count() == 0; })) {
    throw Error(ErrorKind::kInput,
                path + ": there are no strands to write: the scene grows no groom at this frame");
  }
  // A strand file has a single basis.
  for (const Strands& strands : grown) {
    if (strands.basis() != grown.front().basis()) {
      throw Error(ErrorKind::kArguments,
                  "the grooms use different curve bases; choose one groom with --groom");
    }
  }
  for (const auto& [attribute, lacking] : coats_without(grown, coats)) {
    progress.warn(
        fmt::format("{}: strands of {} have no {}; the file says {} for them (--groom chooses one groom)",
                    path, lacking, attribute,
                    attribute == "color"     ? "white"
                    : attribute == "opacity" ? "1"
                                             : "0"));
  }
  const Strands merged = merge(grown);
  warn_of_losses(path, merged, progress);
  write_strands(path, merged);
  std::cout << path << "\n";
}

// When growing caches ahead of time, missing caches must be an error.
void require_kept(const Assets& assets, const Options& options) {
  std::string lost;
  for (const auto& [name, groom] : assets.grooms) {
    if (!options.groom.empty() && name != options.groom) continue;
    if (groom->cache_report() && !groom->cache_report()->stored)
      lost += (lost.empty() ? "'" : ", '") + name + "'";
  }
  if (!lost.empty()) throw Error(ErrorKind::kFailed, "cannot write the cache of groom " + lost);
}

std::string groom_of(const FurPart& part) { return part.name.substr(part.name.rfind('.') + 1); }

/// Grows the coats of a frame, and writes their strands if there is an output. Returns false when cancelled.
bool grow_frame(const SceneDescription& scene, Assets& assets, const Options& options, int frame, Run& run) {
  World world =
      run.stage("pose", [&] { return compose(scene, assets, frame, run.job(), CoordinateOrigin::kWorld); });
  run.statistics().world = world.counts;

  std::vector<Strands> grown;
  std::vector<std::string> coats;  // of each of them
  std::vector<MemoryCharge> charges;
  std::set<std::string> seen;
  for (const FurPart& part : world.scene.fur) {
    const std::string groom = groom_of(part);
    if (!options.groom.empty() && groom != options.groom) continue;
    // Without an output file, each coat is reported once, not for every animal of a crowd.
    if (options.output.empty() && (assets.grooms.at(groom)->cache_report() || !seen.insert(groom).second))
      continue;
    Growth growth = grow(part, !options.output.empty(), run);
    if (run.display().cancelled()) return false;
    report(part.name, growth, run.workers().thread_count());
    const auto leaf_count = static_cast<int64_t>(growth.leaves.size());
    run.statistics().frames.growth +=
        {.chunks = leaf_count, .strands = static_cast<int64_t>(growth.strands), .area = {}};
    run.statistics().frames.residency.expansions += leaf_count;
    run.statistics().stages_s["grow"] += growth.seconds;
    charges.push_back(std::move(growth.charge));
    if (options.output.empty()) continue;
    std::move(growth.leaves.begin(), growth.leaves.end(), std::back_inserter(grown));
    coats.resize(grown.size(), part.name);
  }
  if (!options.output.empty())
    write_grown(frame_file_name(options.output, frame), grown, coats, run.display());
  return true;
}

}  // namespace

int run_grow(const Options& options) {
  Run run(options);
  SceneDescription scene = read_scene(options, run.display());
  // Strands for other programs must not depend on the picture's size or the camera.
  if (!options.output.empty() && !options.lod) scene.render.lod.enabled = false;
  if (!options.groom.empty() && !scene.grooms.find(options.groom)) {
    throw Error(ErrorKind::kArguments, "there is no groom '" + options.groom + "'" +
                                           did_you_mean(options.groom, scene.grooms.names()));
  }
  if (!options.output.empty() && !is_strand_file(options.output)) {
    throw Error(ErrorKind::kArguments, "-o " + options.output + ": strands are written as " + kStrandEndings);
  }
  if (!options.output.empty()) wear_unworn_grooms(scene, options.groom);
  // A file name with a place for the frame number asks for every frame.
  std::vector<int> frames = scene.frames.frames;
  if (!has_frame_pattern(options.output)) frames.resize(1);
  check_stats(options, scene.files);
  if (!options.output.empty()) {
    check_stats(options, {options.output});
    for (const int frame : frames) {
      check_replaces_none("-o", frame_file_name(options.output, frame), scene.files);
      check_replaces_none("-o", frame_file_name(options.output, frame), motion_files(scene, {&frame, 1}));
    }
    prepare_output(frame_file_name(options.output, frames.front()));
  }
  keep_spare_heap(scene.render.memory.bytes, run.workers().thread_count());
  const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });
  // Opening, filling and growing caches is a separate stage.
  double cache_s = 0;
  for (const auto& [name, groom] : assets->grooms) {
    if (groom->cache_report()) cache_s += groom->cache_report()->seconds;
  }
  auto& stages = run.statistics().stages_s;
  stages["read"] = std::max(0.0, stages["read"] - cache_s);
  stages["cache"] = cache_s;
  bool all_cached = true;
  for (const auto& [name, groom] : assets->grooms) {
    if (!options.groom.empty() && name != options.groom) continue;
    all_cached &= groom->cache_report() != nullptr;
    if (groom->cache_report()) report_cache(name, *groom->cache_report(), options.explain);
  }
  if (options.prune) prune_caches(*assets, scene.growth_cache.get());
  if (options.output.empty() && options.groom.empty() && !grow_boxes(scene, *assets, run)) {
    return SignalGuard::exit_code();
  }
  // Cached data needs no pose; strands are made only if requested.
  if (all_cached && options.output.empty()) {
    run.finish(options);
    require_kept(*assets, options);
    return 0;
  }
  for (const int frame : frames) {
    if (!grow_frame(scene, *assets, options, frame, run)) return SignalGuard::exit_code();
  }
  run.finish(options);
  if (options.output.empty()) require_kept(*assets, options);
  return 0;
}

}  // namespace pelage
