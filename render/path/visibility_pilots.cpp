// SPDX-License-Identifier: Apache-2.0
#include "render/path/visibility_pilots.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "base/hash.h"
#include "base/memory_budget.h"
#include "render/accel/flush_denormals.h"
#include "render/frame/sample_scratch.h"

namespace pelage {
namespace {

constexpr uint32_t kVertices = 3;  // of a pilot at which lights are asked
constexpr int kTargets = 4;        // groups of candidates per vertex
constexpr size_t kPixelsPerPilot = 4, kMinPilots = 256, kMaxPilots = size_t(1) << 15;
constexpr uint32_t kNoSkin = std::numeric_limits<uint32_t>::max();
constexpr size_t kMaxFitted = 20000;          // rays to which a shell is fitted
constexpr size_t kBlock = 64, kBatch = 4096;  // pilots of one task, and between two additions to the table

enum Draw : uint32_t { kLight = 0, kLobe = 1, kVertexDraws = 3 };

/// Count of shadow rays of a vertex.
size_t candidates(const FrameScene& scene) {
  return DirectLight(scene.lights, kTargets, DirectTechniques::kBoth).candidates();
}

}  // namespace

/// A shadow ray of a pilot.
struct VisibilityPilots::PilotRay {
  uint32_t light, stratum;
  V3f from;  // the position whose cell learns from this ray
  bool on_strand;
  uint32_t skin;  // whose ball is in `ray`; kNoSkin: none
  ShellRay ray;
};

struct VisibilityPilots::Scratch final : SampleScratch {
  DirectLightScratch direct;
};

VisibilityPilots::VisibilityPilots(const FrameScene& scene, const Accel& accel, const PathOptions& options)
    : scene_(scene),
      accel_(accel),
      shading_(scene, {options.known.balls, nullptr}),
      camera_(scene, accel, true),
      direct_(scene.lights, kTargets, DirectTechniques::kBoth) {}

size_t VisibilityPilots::count(const FrameScene& scene) {
  const auto pixels = static_cast<size_t>(scene.image.width) * static_cast<size_t>(scene.image.height);
  return std::clamp(pixels / kPixelsPerPilot, kMinPilots, kMaxPilots);
}

void VisibilityPilots::follow(size_t pilot, Scratch& scratch, std::vector<PilotRay>& rays) const {
  const auto number = static_cast<uint32_t>(pilot);
  const uint64_t key = hash64(random_use("pilot"), static_cast<uint64_t>(scene_.render.seed), number);
  const int x = static_cast<int>(unit_float(key) * static_cast<float>(scene_.image.width));
  const int y = static_cast<int>(unit_float(mix64(key)) * static_cast<float>(scene_.image.height));
  SampleStream stream(key, static_cast<uint32_t>(x), static_cast<uint32_t>(y), number);
  Ray ray = camera_.draw(x, y, number, stream).ray;
  const uint32_t vertices = std::min(kVertices, static_cast<uint32_t>(scene_.render.bounces) + 1);
  for (uint32_t vertex = 0; vertex < vertices; ++vertex) {
    const Hit hit = scratch.closest(vertex == 0 ? RayKind::kCamera : RayKind::kIndirect, accel_, ray);
    if (!hit) return;
    const ScatterPoint point = shading_.scatter_point(ray, hit, scratch.thread.met);
    const auto leave = [&](const V3f& direction, float far) {
      Ray leaving;
      leaving.origin = point.start(direction);
      leaving.direction = direction;
      leaving.far = far;
      leaving.time = ray.time;
      leaving.random = ray.random + 1;
      leaving.start = point.can_hit_own_strand() ? hit.start.without_strand() : hit.start;
      return leaving;
    };
    const uint32_t draws = static_cast<uint32_t>(SampleDraw::kFirstVertex) + kVertexDraws * vertex;
    direct_.begin(point, scratch.direct);
    stream.seek(draws + kLight);
    direct_.propose(
        point, stream.next2d(), [](const FibreValue& value) { return value.pdf; }, scratch.direct);
    const bool on_strand = hit.kind == HitKind::kStrand;
    const SkinShadow& below = point.shadow();
    for (const LightPoint& to : scratch.direct.points) {
      const Ray shadow = leave(to.direction, to.distance * DirectLight::kJustBefore);
      const float through = scratch.light_through(accel_, shadow);
      rays.push_back({static_cast<uint32_t>(to.light),
                      to.stratum,
                      point.position(),
                      on_strand,
                      below.ball.radius > 0 ? below.skin : kNoSkin,
                      {below.ball, shadow.origin, shadow.direction, shadow.far, through}});
    }
    stream.seek(draws + kLobe);
    const auto sample = point.sample(stream.next3d());
    if (!sample) return;
    ray = leave(sample->wi, std::numeric_limits<float>::infinity());
  }
}

/// Traces the pilots begin .. end - 1.
VisibilityPilots::PilotRays VisibilityPilots::trace(size_t begin, size_t end, const Job& job,
                                                    std::vector<Scratch>& scratch) const {
  PilotRays rays((end - begin + kBlock - 1) / kBlock);
  job.for_each(rays.size(), 1, [&](WorkRange range) {
    const FlushDenormals flush;
    Scratch& own = scratch[static_cast<size_t>(range.worker)];
    own.thread.worker = range.worker;
    const TileTimer timer(own.costs);
    for (size_t block = range.begin; block < range.end; ++block) {
      const size_t first = begin + block * kBlock;
      for (size_t i = first; i < std::min(first + kBlock, end); ++i) follow(i, own, rays[block]);
    }
  });
  return rays;
}

/// Upper bound of the memory of the rays of kBatch pilots.
int64_t VisibilityPilots::batch_bytes(const FrameScene& scene) {
  const size_t rays = std::min(kBatch, count(scene)) * kVertices * candidates(scene);
  return static_cast<int64_t>(2 * rays * sizeof(PilotRay));
}

PilotNeeds VisibilityPilots::needs_of_rays(const FrameScene& scene, size_t pilots) {
  const size_t vertices = std::min<size_t>(kVertices, static_cast<size_t>(scene.render.bounces) + 1);
  PilotNeeds needs;
  needs.rays = static_cast<int64_t>(pilots * vertices * (1 + candidates(scene)));
  return needs;
}

PilotNeeds VisibilityPilots::needs_of_table(const FrameScene& scene) {
  PilotNeeds needs = needs_of_rays(scene, count(scene));
  const size_t lights = scene.lights.size();
  const size_t cells = std::min(count(scene) * kVertices, VisibilityTable::max_cells(lights));
  needs.tracing_bytes =
      static_cast<int64_t>(cells * VisibilityTable::bytes_per_cell(lights, true)) + batch_bytes(scene);
  needs.held_bytes = static_cast<int64_t>(cells * VisibilityTable::bytes_per_cell(lights, false));
  return needs;
}

PilotNeeds VisibilityPilots::needs_of_shells(const FrameScene& scene) {
  PilotNeeds needs = needs_of_rays(scene, std::min(count(scene), kBatch));
  needs.tracing_bytes = 2 * batch_bytes(scene);
  return needs;
}

void VisibilityPilots::add_costs(const std::vector<Scratch>& scratch, FrameStatistics& statistics) {
  for (const Scratch& of_thread : scratch) {
    statistics.trace += of_thread.thread.counts;
    statistics.rays += of_thread.costs.rays.counts();
    statistics.occlusion.pilot_rays += of_thread.costs.rays.counts().total();
  }
}

std::unique_ptr<const VisibilityTable> VisibilityPilots::learn(const Job& job,
                                                               FrameStatistics& statistics) const {
  const size_t pilots = count(scene_), lights = scene_.lights.size();
  MemoryCharge charge = reserve(job.ledger, MemoryTag::kReflectionCache, needs_of_table(scene_).tracing_bytes,
                                "learning the visibility of lights");
  auto table = std::make_unique<VisibilityTable>(scene_.camera.lod_view(), lights);
  std::vector<Scratch> scratch(static_cast<size_t>(job.workers.thread_count()));
  for (size_t begin = 0; begin < pilots; begin += kBatch) {
    // In the order of the pilots, so that sums of floats do not depend on threads.
    for (const auto& block : trace(begin, std::min(begin + kBatch, pilots), job, scratch)) {
      for (const PilotRay& ray : block)
        table->add(table->key(ray.from, ray.on_strand), ray.light, ray.stratum, ray.ray.through);
    }
  }
  table->freeze(scene_.render.learned_visibility);
  charge = {};
  table->charge(job.ledger);
  add_costs(scratch, statistics);
  return table;
}

std::vector<CoatShell> VisibilityPilots::fit_shells(const Job& job, FrameStatistics& statistics) const {
  const MemoryCharge charge = reserve(job.ledger, MemoryTag::kReflectionCache,
                                      needs_of_shells(scene_).tracing_bytes, "fitting the shells of coats");
  std::vector<Scratch> scratch(static_cast<size_t>(job.workers.thread_count()));
  std::vector<std::vector<ShellRay>> by_skin(scene_.skins.size());
  for (const auto& block : trace(0, std::min(count(scene_), kBatch), job, scratch)) {
    for (const PilotRay& ray : block) {
      const bool is_used = ray.on_strand && ray.skin != kNoSkin && by_skin[ray.skin].size() < kMaxFitted;
      if (is_used) by_skin[ray.skin].push_back(ray.ray);
    }
  }
  std::vector<CoatShell> shells;
  for (const auto& rays : by_skin) shells.push_back(fit_shell(rays));
  add_costs(scratch, statistics);
  return shells;
}

}  // namespace pelage
