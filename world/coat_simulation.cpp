// SPDX-License-Identifier: Apache-2.0
#include "world/coat_simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "base/check.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "geom/closest_point.h"
#include "groom/operators/follow.h"
#include "groom/sim/guide_simulation.h"
#include "world/guide_poses.h"

namespace pelage {
namespace {

/// Triangles of a skin at a time, to collide with.
struct PosedTriangles {
  SkinMesh mesh;
  std::optional<ClosestPointTree> tree;
  Box3f box;

  PosedTriangles(const LimitSurface& skin, const Job& job) : mesh(guide_triangles(skin, job)) {
    if (mesh.triangle_count() == 0) return;
    tree.emplace(mesh, 0, &job);
    for (size_t v = 0; v < mesh.vertex_count(); ++v) box.extendBy(mesh.position(v));
  }
};
using Shapes = std::vector<std::shared_ptr<const PosedTriangles>>;

OtherSkin other_skin(const PosedTriangles& before, const PosedTriangles& now) {
  PELAGE_CHECK(before.mesh.vertex_count() == now.mesh.vertex_count());
  PELAGE_CHECK(before.mesh.triangle_count() == now.mesh.triangle_count());
  OtherSkin skin{&before.mesh, &now.mesh, &*before.tree, &*now.tree, before.box, now.box, 0};
  for (size_t v = 0; v < now.mesh.vertex_count(); ++v) {
    const V3d moved = V3d(now.mesh.position(v)) - V3d(before.mesh.position(v));
    skin.motion = std::max(skin.motion, moved.length());
  }
  return skin;
}

/// The skins around a moving coat at a time, with what its SkinMoment refers to.
struct PosedMoment {
  std::optional<PosedTriangles> own;
  Shapes before, others;
  SkinMoment moment;
};

class CoatSimulation {
 public:
  CoatSimulation(const SceneDescription& scene, const Assets& assets, const MovingCoat& coat, const Job& job)
      : scene_(scene), assets_(assets), coat_(coat), job_(job), unit_(scene.units.meters_per_unit) {
    const size_t points = coat.segments() + 2 * coat.groom->guides()->follicles.size();
    charge_ = reserve(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(points * kBytesOfPoint),
                      "simulating " + coat.name);
  }

  GuideSimulation start() const {
    const auto at = posed(coat_.start);
    return GuideSimulation(*coat_.params, shapes(), at->moment);
  }

  void resume(int frame, std::span<const float> state, GuideSimulation& guides) const {
    guides.set_state(state, posed(frame)->moment);
  }

  FrameMotionData advance(int frame, GuideSimulation& guides) {
    FrameMotionData motion;
    const double half = 0.5 / scene_.units.fps;
    if (others_.empty()) others_ = other_shapes(frame - 1);
    for (const double time : {frame - 0.5, static_cast<double>(frame)}) {
      const auto at = posed(time);
      add_others(time, *at);
      const Wind wind(coat_.params->wind, time, time / scene_.units.fps);
      guides.advance(at->moment, wind, half, coat_.steps_per_half(), job_);
      (time < frame ? motion.half : motion.whole) = guides.turns();
      if (time < frame) continue;
      // The next frame starts from what the file holds.
      motion.state = guides.state();
      guides.set_state(motion.state, at->moment);
    }
    return motion;
  }

 private:
  static constexpr size_t kBytesOfPoint = 600;

  /// The skins that guides must not pass, without their own. Those without triangles have no tree.
  Shapes other_shapes(double time) const {
    Shapes shapes;
    for (const auto& [character, part] : coat_.colliders)
      shapes.push_back(std::make_shared<PosedTriangles>(posed_skin(character, part, assets_, time), job_));
    return shapes;
  }

  /// Adds the other skins, and how they came from where they were in the last moment.
  void add_others(double time, PosedMoment& at) {
    if (coat_.colliders.empty()) return;
    at.before = std::move(others_);
    at.others = others_ = other_shapes(time);
    for (size_t i = 0; i < at.others.size(); ++i) {
      if (at.before[i]->tree && at.others[i]->tree)
        at.moment.others.push_back(other_skin(*at.before[i], *at.others[i]));
    }
  }

  std::unique_ptr<PosedMoment> posed(double time) const {
    const LimitSurface skin = posed_skin(coat_.character, coat_.part, assets_, time);
    auto at = std::make_unique<PosedMoment>();
    at->moment.meters_per_unit = unit_;
    at->moment.roots = guide_roots(*coat_.groom, skin, unit_);
    if (!coat_.params->collide) return at;
    at->own.emplace(skin, job_);
    if (at->own->tree) at->moment.skin = &*at->own->tree;
    return at;
  }

  /// The guides as groomed, grown on the skin at rest.
  std::vector<GuideShape> shapes() const {
    const Groom& groom = *coat_.groom;
    const LimitSurface& rest = *assets_.skins.at(coat_.character.params->parts[coat_.part].skin.name).rest;
    const double scale = coat_.character.params->transform.scale.at(coat_.start) * unit_;
    std::vector<GuideShape> shapes = groomed_guides(groom, rest, scale, job_);
    const RestPose pose(rest, groom.needs_closest_point(), job_);
    groom.visit_guides(pose.skin(), [&](size_t guide, const Strands& strands, size_t s) {
      const size_t middle = (strands.first_point(s) + strands.first_point(s + 1)) / 2;
      const std::optional<float>& diameter = coat_.params->diameter;
      shapes[guide].radius = diameter ? *diameter / 2 : strands.radius(middle) * scale;
    });
    return shapes;
  }

  const SceneDescription& scene_;
  const Assets& assets_;
  const MovingCoat& coat_;
  const Job& job_;
  const double unit_;
  MemoryCharge charge_;
  Shapes others_;  // of the last moment
};

}  // namespace

SimulationReport simulate(const SceneDescription& scene, const Assets& assets, const MovingCoat& coat,
                          int first, int last, const Job& job, const std::function<void(int)>& done) {
  SimulationReport report;
  const auto began = std::chrono::steady_clock::now();
  constexpr int64_t kMaxFrames = 1'000'000;
  if (int64_t{last} - coat.start > kMaxFrames) {
    throw Error(ErrorKind::kArguments,
                fmt::format("frame {} is more than {} frames after the begin of the simulation of coat '{}'",
                            last, kMaxFrames, coat.name));
  }
  first = std::max(first, coat.start + 1);
  std::vector<int> missing;
  const WarningSink warn = [&](const std::string& line) { job.progress.warn(line); };
  const WarningSink silent = [](const std::string&) {};
  for (int frame = first; frame <= last; ++frame) {
    if (coat.store.read(frame, coat.segments(), false, warn)) {
      ++report.found;
    } else {
      missing.push_back(frame);
    }
  }
  report.begun = coat.start;
  if (missing.empty()) return report;
  CoatSimulation simulation(scene, assets, coat, job);
  GuideSimulation guides = simulation.start();
  int frame = missing.front() - 1;
  for (; frame > coat.start; --frame) {
    job.check_stop();
    const auto stored = coat.store.read(frame, coat.segments(), true, silent);
    if (!stored || stored->state.size() != guides.state_size()) continue;
    simulation.resume(frame, stored->state, guides);
    break;
  }
  report.begun = frame;
  while (++frame <= missing.back()) {
    job.check_stop();
    const FrameMotionData motion = simulation.advance(frame, guides);
    ++report.simulated;
    report.most_rigid = std::max(report.most_rigid, guides.rigid_count());
    report.rigid_frames += guides.rigid_count() > 0;
    if (!coat.store.write(frame, motion, warn))
      throw Error(ErrorKind::kFailed, "cannot write the motion of coat '" + coat.name + "'");
    done(frame);
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return report;
}

}  // namespace pelage
