// SPDX-License-Identifier: Apache-2.0
#include "world/scene_session.h"

#include "base/process_usage.h"
#include "base/stopwatch.h"
#include "groom/operators/operator_scripts.h"
#include "rib/document/rib_document.h"
#include "scene/overrides.h"
#include "scene/renamed_keys.h"
#include "scene/yaml_reader.h"
#include "world/grow_coat.h"

namespace pelage {
namespace {

std::shared_ptr<const OperatorScripts> scripts_for(ScriptUse use) {
  return use == ScriptUse::kAllowed ? python_scripts() : nullptr;
}

}  // namespace

SceneSession::SceneSession(const std::filesystem::path& path, const std::vector<Override>& changes,
                           int threads, ScriptUse scripts)
    : scripts_(scripts_for(scripts)),
      workers_(threads),
      document_(changed(read_file(path), changes)),
      scene_(checked(document_)) {}

SceneSession::SceneSession(Value document, const std::vector<Override>& changes, int threads,
                           ScriptUse scripts)
    : scripts_(scripts_for(scripts)),
      workers_(threads),
      document_(changed({std::move(document), {}, {}}, changes)),
      scene_(checked(document_)) {}

SceneSession::~SceneSession() = default;

SceneSession::Document SceneSession::read_file(const std::filesystem::path& path) {
  if (is_rib(path)) {
    throw Error(ErrorKind::kArguments, {path.string(), 0, 0},
                "a RIB file cannot be edited as a scene; name it under `archives` of a scene");
  }
  Problems problems;
  RenamedKeys renamed{SceneDescription::schema()};
  std::optional<Value> root = load_document(path, {}, problems, &renamed);
  if (!problems.empty() || !root) load_scene(path);  // reports the mistakes in the values, too
  problems.throw_if_any();
  return {std::move(*root), {}, std::move(renamed.warnings)};
}

std::shared_ptr<const SceneDescription> SceneSession::checked(const Document& document) const {
  SceneDescription scene = make_scene(document.root, document.frames);
  scene.warnings.insert(scene.warnings.begin(), document.warnings.begin(), document.warnings.end());
  scene.scripts = scripts_;
  return std::make_shared<const SceneDescription>(std::move(scene));
}

SceneSession::Document SceneSession::changed(Document document, const std::vector<Override>& changes) {
  Problems problems;
  DocumentLimits limits;
  RenamedKeys renamed{SceneDescription::schema()};
  for (Override change : changes) {
    // A text, too, is a value of the host: errors name its key, not the flag --set.
    if (!change.given)
      change.given = read_yaml(change.value, change.key, SourcePosition{change.key, 0, 0}, limits, problems);
    if (!change.given) continue;
    if (change.key == "frames") {
      document.frames = {change};
      continue;
    }
    apply_override(change, document.root, limits, problems, &renamed);
    rename_old_keys(document.root, renamed, problems);
  }
  problems.throw_if_any();
  document.warnings.insert(document.warnings.end(), renamed.warnings.begin(), renamed.warnings.end());
  return document;
}

void SceneSession::set(const std::vector<Override>& changes) {
  const std::lock_guard lock(values_);
  Document next = changed(document_, changes);
  scene_ = checked(next);
  document_ = std::move(next);
}

void SceneSession::check(const std::vector<Override>& changes) const {
  Document now;
  {
    const std::lock_guard lock(values_);
    now = document_;
  }
  checked(changed(std::move(now), changes));
}

std::shared_ptr<const SceneDescription> SceneSession::scene() const {
  const std::lock_guard lock(values_);
  return scene_;
}

Assets& SceneSession::assets_of(const SceneDescription& scene, const Job& job) {
  if (assets_ && loaded_ == scene.hash) return *assets_;
  loaded_.clear();
  if (!assets_) assets_ = std::make_unique<Assets>(ledger_);
  update_assets(scene, job, *assets_);
  loaded_ = scene.hash;
  return *assets_;
}

Strands SceneSession::grow(const std::string& coat, std::optional<double> frame, Progress& progress) {
  const std::lock_guard lock(work_);
  const auto current = this->scene();
  const Job job{workers_, ledger_, progress};
  Assets& assets = assets_of(*current, job);
  SceneDescription scene = *current;
  scene.render.lod.enabled = false;
  const World world =
      compose(scene, assets, frame.value_or(scene.frames.frames.front()), job, CoordinateOrigin::kWorld);
  return grow_coat(world, coat, job);
}

RenderedFrame SceneSession::render(std::optional<double> frame, Progress& progress,
                                   const FrameOptions& options) {
  const std::lock_guard lock(work_);
  const Stopwatch clock;
  const double cpu_before = cpu_seconds();
  const auto scene = this->scene();
  const Job job{workers_, ledger_, progress};
  MemoryCharge film = reserve_film(*scene, job, options.region);
  Assets& assets = assets_of(*scene, job);
  film = {};  // render() makes its own
  const double read_s = clock.seconds();
  const World world = compose(*scene, assets, frame.value_or(scene->frames.frames.front()), job);
  const double posed_s = clock.seconds();
  FrameResult result = pelage::render(world, job, options);
  if (result.mean_samples == 0) throw Error(ErrorKind::kStopped, "stopped before the first sample");

  Statistics statistics;
  statistics.world = world.counts;
  for (const auto& [name, groom] : assets.grooms) statistics.repairs += groom->repairs();
  statistics.stages_s = {{"read", read_s}, {"pose", posed_s - read_s}};
  statistics.add(result, posed_s, 1);
  statistics.process.wall_s = clock.seconds();
  statistics.process.cpu_s = cpu_seconds() - cpu_before;
  statistics.process.peak_rss_bytes = peak_rss_bytes();
  for (int tag = 0; tag < static_cast<int>(MemoryTag::kCount); ++tag) {
    const auto memory_tag = static_cast<MemoryTag>(tag);
    statistics.process.memory_bytes[std::string(memory_tag_name(memory_tag))] = ledger_.peak(memory_tag);
  }
  FrameHeader header = finished_header(world, result, clock.seconds());
  return {std::move(result), std::move(header), world.scene.camera, std::move(statistics)};
}

}  // namespace pelage
