// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_interpreter.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/memory_budget.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr size_t kMaxFiles = 100;           // of nested archives
constexpr size_t kMaxArchives = 1'000'000;  // read in all

}  // namespace

RibInterpreter::RibInterpreter(const RibReadOptions& options, RibContext context)
    : options_(options),
      context_(std::move(context)),
      batches_([this](size_t coat, Strands batch) { keep_batch(coat, std::move(batch)); }) {}

RibInterpreter::Handler RibInterpreter::handler(const std::string& name) {
  // No effect on the picture of a path tracer.
  static const std::set<std::string> ignored = {
      "Clipping",   "version",        "Orientation",          "ReverseOrientation",
      "Sides",      "ShadingRate",    "ShadingInterpolation", "GeometricApproximation",
      "Integrator", "DisplayChannel", "PixelFilter",          "PixelVariance",
      "Quantize",   "Bound",          "ErrorHandler",         "Illuminate"};
  if (ignored.contains(name)) return &RibInterpreter::ignore;
  const Handler found = content_handler(name);
  return found ? found : state_handler(name);
}

/// Of requests that change the graphics state, the camera or options.
RibInterpreter::Handler RibInterpreter::state_handler(const std::string& name) {
  using I = RibInterpreter;
  static const std::map<std::string, Handler> table = {
      {"AttributeBegin", &I::begin_block},
      {"AttributeEnd", &I::end_block},
      {"TransformBegin", &I::begin_block},
      {"TransformEnd", &I::end_block},
      {"SolidBegin", &I::begin_block},
      {"SolidEnd", &I::end_block},
      {"FrameBegin", &I::begin_frame},
      {"FrameEnd", &I::end_block},
      {"WorldBegin", &I::begin_world},
      {"WorldEnd", &I::end_block},
      {"MotionBegin", &I::begin_motion},
      {"MotionEnd", &I::end_motion},
      {"ConcatTransform", &I::transform},
      {"Translate", &I::transform},
      {"Rotate", &I::transform},
      {"Scale", &I::transform},
      {"Transform", &I::set_transform},
      {"Identity", &I::set_transform},
      {"CoordinateSystem", &I::coordinate_system},
      {"ScopedCoordinateSystem", &I::coordinate_system},
      {"CoordSysTransform", &I::use_coordinate_system},
      {"Color", &I::color},
      {"Basis", &I::basis},
      {"Attribute", &I::attribute},
      {"Declare", &I::declare},
      {"Projection", &I::projection},
      {"ScreenWindow", &I::camera_numbers},
      {"DepthOfField", &I::camera_numbers},
      {"Shutter", &I::camera_numbers},
      {"Format", &I::camera_numbers},
      {"FrameAspectRatio", &I::camera_numbers},
      {"PixelSamples", &I::camera_numbers},
      {"Exposure", &I::camera_numbers},
      {"Display", &I::display},
      {"Option", &I::option},
      {"Opacity", &I::opacity},
      {"Camera", &I::named_camera},
      {"Hider", &I::hider},
  };
  const auto found = table.find(name);
  return found == table.end() ? nullptr : found->second;
}

/// Of requests for geometry, lights, shaders and archives.
RibInterpreter::Handler RibInterpreter::content_handler(const std::string& name) {
  using I = RibInterpreter;
  static const std::map<std::string, Handler> table = {
      {"ObjectBegin", &I::begin_object},
      {"ArchiveBegin", &I::begin_object},
      {"ObjectInstance", &I::instance},
      {"Surface", &I::surface},
      {"LightSource", &I::light_source},
      {"AreaLightSource", &I::area_light_source},
      {"Curves", &I::curves},
      {"SubdivisionMesh", &I::mesh},
      {"PointsPolygons", &I::mesh},
      {"PointsGeneralPolygons", &I::mesh},
      {"Polygon", &I::mesh},
      {"Patch", &I::patch},
      {"Sphere", &I::quadric},
      {"Bxdf", &I::bxdf},
      {"Pattern", &I::pattern},
      {"Light", &I::ris_light},
      {"HierarchicalSubdivisionMesh", &I::mesh},
      {"GeneralPolygon", &I::mesh},
      {"PatchMesh", &I::patch},
      {"NuPatch", &I::patch},
      {"Cone", &I::quadric},
      {"Cylinder", &I::quadric},
      {"Disk", &I::quadric},
      {"Hyperboloid", &I::quadric},
      {"Paraboloid", &I::quadric},
      {"Torus", &I::quadric},
      {"ReadArchive", &I::read_archive},
      {"Procedural", &I::procedural},
      {"Procedural2", &I::procedural},
  };
  const auto found = table.find(name);
  return found == table.end() ? nullptr : found->second;
}

void RibInterpreter::warn_once(const std::string& kind, const SourcePosition& position,
                               const std::string& message) {
  if (warned_.insert(kind).second) scene_.warnings.push_back({position, message});
}

void RibInterpreter::skipped(const RibStatement& request) {
  warn_once(request.name, request.position(),
            "request " + quote(request.name) + " is not supported; skipped");
}

void RibInterpreter::drop(const std::string& what, const SourcePosition& position, size_t count) {
  if (count == 0) return;
  Dropped& dropped = dropped_[what];
  if (dropped.count == 0) dropped.first = position;
  dropped.count += count;
}

void RibInterpreter::warn_undeclared(const RibStatement& request,
                                     const std::vector<std::string>& parameters) {
  for (const std::string& parameter : parameters)
    warn_once("undeclared " + parameter, request.position(),
              "parameter " + quote(parameter) + " of " + request.name + " has no known type; skipped");
}

void RibInterpreter::read_file(const std::filesystem::path& path, const RibStatement* named_at) {
  std::error_code ignored;
  const std::filesystem::path identity = std::filesystem::weakly_canonical(path, ignored);
  if (named_at) {
    if (std::find(reading_.begin(), reading_.end(), identity) != reading_.end())
      named_at->fail("the file reads itself: " + quote(path.filename().string()));
    if (reading_.size() >= kMaxFiles) named_at->fail(fmt::format("more than {} nested archives", kMaxFiles));
    if (++archives_ > kMaxArchives)
      named_at->fail(fmt::format("more than {} archives are read", kMaxArchives));
    if (reading_.size() > 1 && ++inner_archives_ > options_.max_inner_archives)
      named_at->fail(fmt::format("archives read more than {} archives", options_.max_inner_archives));
  }
  scene_.files.insert(path);
  reading_.push_back(identity);
  RibStatement request;
  RibReader reader(path, [&](size_t bytes) { allow_request(request, bytes); });
  while (!stopped_ && reader.next(request)) {
    if (options_.check_stop && ++statements_ % 64 == 0) options_.check_stop();
    execute(request);
  }
  reading_.pop_back();
}

void RibInterpreter::allow_request(const RibStatement& request, size_t bytes) {
  if (bytes > options_.max_request_bytes)
    request.fail(fmt::format("one request may take {} of memory (render.memory)",
                             memory_text(static_cast<int64_t>(options_.max_request_bytes))));
  if (options_.reserve) options_.reserve(kept_bytes_ + bytes);
  largest_request_ = std::max(largest_request_, bytes);
}

void RibInterpreter::keep(const RibStatement& request, std::vector<RibStatement>& list) {
  list.push_back(request);
  kept_bytes_ += list.back().bytes();
  if (options_.reserve) options_.reserve(kept_bytes_);
}

bool RibInterpreter::skip(const RibStatement& request) {
  if (skip_until_.empty()) return false;
  if (request.name == skip_until_) skip_until_.clear();
  return true;
}

bool RibInterpreter::record(const RibStatement& request) {
  if (recording_.empty()) return false;
  if (request.name == recording_) {
    recording_.clear();
  } else if (request.name == "ObjectBegin" || request.name == "ArchiveBegin") {
    request.fail("an object within an object");
  } else {
    keep(request, objects_[recorded_]);
  }
  return true;
}

void RibInterpreter::execute(RibStatement& request) {
  if (skip(request) || record(request)) return;
  if (in_motion_ && request.name != "MotionEnd") {
    if (samples_.size() == times_.size()) request.fail("the motion block has more requests than times");
    keep(request, samples_);
    return;
  }
  dispatch({std::span(&request, 1), {}});
}

void RibInterpreter::dispatch(const Call& call) {
  const Handler handle = handler(call.request().name);
  if (!handle) {
    skipped(call.request());
    return;
  }
  (this->*handle)(call);
}

void RibInterpreter::finish() {
  if (!recording_.empty()) throw Error(ErrorKind::kInput, opened_at_, "the object has no " + recording_);
  if (in_motion_) throw Error(ErrorKind::kInput, opened_at_, "the motion block has no MotionEnd");
  if (!blocks_.empty()) {
    const Block& open = blocks_.back();
    throw Error(ErrorKind::kInput, {open.file, open.line, open.column},
                open.name + "Begin has no " + open.name + "End");
  }
  batches_.finish();
  for (const auto& [what, dropped] : dropped_)
    scene_.warnings.push_back({dropped.first, fmt::format("{}: {}", what, dropped.count)});
}

RibScene read_rib(const std::filesystem::path& path, const RibReadOptions& options) {
  RibContext context;
  context.folder = path.parent_path();
  context.shutter.times = options.shutter;
  context.world = context.attributes.to_world = options.placement;
  RibInterpreter interpreter(options, std::move(context));
  interpreter.read_file(path, nullptr);
  interpreter.finish();
  if (interpreter.is_shadow_pass()) {
    RibReadOptions with_shadows = options;
    with_shadows.shadow_passes = true;
    RibScene scene = read_rib(path, with_shadows);
    scene.shadow_pass = true;
    return scene;
  }
  return std::move(interpreter.scene());
}

}  // namespace pelage
