// SPDX-License-Identifier: Apache-2.0
#include "view/live_renderer.h"

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "base/job.h"
#include "render/frame/frame_geometry.h"
#include "render/frame/frame_watch.h"
#include "world/world.h"

namespace pelage {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

/// The last edit that was read completely. The geometry refers to the world, and the world to the assets.
struct LiveRenderer::Loaded {
  std::shared_ptr<const SceneEdit> edit;
  std::unique_ptr<Assets> assets;
  std::unique_ptr<World> world;
  std::unique_ptr<const FrameGeometry> geometry;

  double frame() const { return edit->scene.frames.frames.front(); }
};

/// Shows the stage of the work on the desk.
class LiveRenderer::StageProgress final : public Progress {
 public:
  explicit StageProgress(const LiveRenderer& renderer) : renderer_(renderer), desk_(renderer.desk_) {}

  void begin(std::string_view stage, double total) override {
    const std::lock_guard lock(mutex_);
    stages_.push_back({std::string(stage), total, 0});
    show();
  }
  void advance(double amount) override {
    const std::lock_guard lock(mutex_);
    if (stages_.empty()) return;
    Stage& stage = stages_.back();
    stage.done += amount;
    if (stage.total > 0 && stage.done / stage.total - shown_ > 0.005) show();
  }
  void expect(double total) override {
    const std::lock_guard lock(mutex_);
    if (!stages_.empty()) stages_.back().total = total;
  }
  void end() override {
    const std::lock_guard lock(mutex_);
    if (!stages_.empty()) stages_.pop_back();
    show();
  }
  void warn(std::string_view line) override {
    desk_.update([&](ViewStatus& status) {
      constexpr size_t kMax = 20;
      status.warnings.emplace_back(line);
      if (status.warnings.size() > kMax) status.warnings.erase(status.warnings.begin());
    });
  }
  bool cancelled() const override { return renderer_.must_end(); }

 private:
  struct Stage {
    std::string name;
    double total = 0, done = 0;
  };
  void show() {
    const Stage stage = stages_.empty() ? Stage{} : stages_.back();
    shown_ = stage.total > 0 ? std::min(stage.done / stage.total, 1.0) : 0;
    desk_.update([&](ViewStatus& status) {
      status.stage = stage.name;
      status.progress = shown_;
      status.memory_bytes = renderer_.ledger_.budgeted();
    });
  }

  const LiveRenderer& renderer_;
  ViewDesk& desk_;
  std::mutex mutex_;
  std::vector<Stage> stages_;
  double shown_ = 0;
};

/// Publishes a picture after each pass.
class LiveRenderer::Watch final : public FrameWatch {
 public:
  Watch(LiveRenderer& renderer, const SceneEdit& edit) : renderer_(renderer), edit_(edit) {}

  void passed(const Film& film, const PassState& state) override {
    ViewDesk& desk = renderer_.desk_;
    std::vector<std::string> names;
    Picture picture;
    picture.width = film.width();
    picture.height = film.height();
    picture.grid = state.grid;
    picture.samples = state.samples;
    picture.layers = film_layers(
        film, [&](const std::string& layer) { return desk.is_wanted(layer); }, &names);
    desk.publish(std::move(picture));
    const int64_t regrown = renderer_.strands_regrown();
    desk.update([&](ViewStatus& status) {
      if (status.first_pixels_s == 0) status.first_pixels_s = seconds_since(edit_.noticed);
      status.mean_samples = state.mean_samples;
      status.layers = std::move(names);
      status.strands_regrown = regrown;
    });
  }

 private:
  LiveRenderer& renderer_;
  const SceneEdit& edit_;
};

LiveRenderer::LiveRenderer(ViewDesk& desk, int threads)
    : desk_(desk), workers_(threads), thread_([this] { run(); }) {}

LiveRenderer::~LiveRenderer() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
  desk_.discard_frame();  // its film is charged to ledger_
}

void LiveRenderer::submit(std::shared_ptr<const SceneEdit> edit) {
  desk_.update([](ViewStatus& status) {
    status.at_rest = false;
    status.render_error.clear();
  });
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(edit);
    waiting_ = true;
  }
  changed_.notify_all();
}

void LiveRenderer::run() {
  while (true) {
    std::shared_ptr<const SceneEdit> edit;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return must_end(); });
      if (stopped_) return;
      edit = std::exchange(next_, nullptr);
      waiting_ = false;
    }
    const auto fail = [this](const std::string& message) {
      desk_.update([&](ViewStatus& status) {
        status.stage.clear();
        status.render_error = message;
      });
    };
    try {
      render(edit);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kStopped) fail(error.what());
    } catch (const std::bad_alloc&) {
      loaded_ = nullptr;
      fail("out of memory");
    } catch (const std::exception& error) {
      loaded_ = nullptr;
      fail(error.what());
    }
  }
}

void LiveRenderer::render(const std::shared_ptr<const SceneEdit>& edit) {
  desk_.update([&](ViewStatus& status) {
    status.at_rest = false;
    status.render_error.clear();
    status.mean_samples = status.first_pixels_s = status.render_s = 0;
    status.strands_regrown = 0;
    status.wanted_samples = edit->scene.render.samples;
    status.edits += began_;
    status.warnings.clear();
    for (const Problem& warning : edit->scene.warnings)
      status.warnings.push_back(to_string(warning.position) + ": " + warning.message);
  });
  began_ = true;
  desk_.discard_frame();
  StageProgress progress(*this);
  const Job job{workers_, ledger_, progress};
  const Redo redo = loaded_ ? edit->redo_after(*loaded_->edit) : Redo::kAssets;
  if (redo > Redo::kSampling && loaded_) loaded_->geometry = nullptr;
  keeps_geometry_ = loaded_ && loaded_->geometry;
  regrown_before_ = keeps_geometry_ ? loaded_->geometry->strands_regrown() : 0;
  if (redo == Redo::kAssets) {
    loaded_ = nullptr;
    auto loaded = std::make_unique<Loaded>();
    progress.begin("read", 1);
    MemoryCharge film = reserve_film(edit->scene, job);
    loaded->edit = edit;
    loaded->assets = load_assets(edit->scene, job);
    progress.end();
    loaded_ = std::move(loaded);
  } else if (redo == Redo::kGeometry) {
    loaded_->assets->materials = load_materials(edit->scene, loaded_->assets->textures, job);
  }
  if (redo >= Redo::kGeometry) {
    progress.begin("pose", 1);
    loaded_->world = nullptr;
    loaded_->edit = edit;
    try {
      loaded_->world = std::make_unique<World>(compose(edit->scene, *loaded_->assets, loaded_->frame(), job));
    } catch (...) {
      loaded_ = nullptr;
      throw;
    }
    progress.end();
  } else if (redo == Redo::kSampling) {
    recompose_sampling(edit->scene, *loaded_->assets, loaded_->frame(), job, *loaded_->world);
  }
  loaded_->edit = edit;
  render_loaded(*edit, job);
}

void LiveRenderer::render_loaded(const SceneEdit& edit, const Job& job) {
  Watch watch(*this, edit);
  RenderParams& params = loaded_->world->scene.render;
  if (params.integrator == Integrator::kGather) {
    // `gather` shows its picture only at the end. One sample per pixel with `path` comes before it.
    ImageParams& image = loaded_->world->scene.image;
    const RenderParams wanted = params;
    const ImageParams wanted_image = image;
    params.integrator = Integrator::kPath;
    params.samples = 1;
    image.filter_samples = FilterSamples::kDrawn;
    bool partial = false;
    try {
      partial = trace(job, watch).partial;
    } catch (...) {
      params = wanted;
      image = wanted_image;
      throw;
    }
    params = wanted;
    image = wanted_image;
    if (partial) return;
    if (params.min_width() > 0) {  // the geometry of `path` has no widened strands
      loaded_->geometry = nullptr;
      keeps_geometry_ = false;
    }
  }
  FrameResult result = trace(job, watch);
  if (!result.partial) finish(edit, std::move(result));
}

FrameResult LiveRenderer::trace(const Job& job, FrameWatch& watch) {
  FrameOptions options;
  options.watch = &watch;
  try {
    return pelage::render(*loaded_->world, job, options, loaded_->geometry);
  } catch (const Error& error) {
    // The film is charged before the geometry. With geometry that is kept, it may not fit.
    if (error.kind() != ErrorKind::kMemory || !loaded_->geometry) throw;
  }
  loaded_->geometry = nullptr;
  keeps_geometry_ = false;
  return pelage::render(*loaded_->world, job, options, loaded_->geometry);
}

void LiveRenderer::finish(const SceneEdit& edit, FrameResult result) {
  const double seconds = seconds_since(edit.noticed);
  const double mean_samples = result.mean_samples;
  std::vector<std::string> names;
  Picture picture;
  picture.width = result.film.width();
  picture.height = result.film.height();
  picture.samples = result.samples;
  picture.layers = film_layers(
      result.film, [this](const std::string& layer) { return desk_.is_wanted(layer); }, &names);
  FrameHeader header = finished_header(*loaded_->world, result, seconds);
  auto frame = std::make_unique<const FinishedFrame>(
      FinishedFrame{std::move(result), std::move(header), loaded_->world->scene.camera});
  desk_.publish(std::move(picture), std::move(frame));
  const int64_t regrown = strands_regrown();
  const bool waiting = waiting_;
  desk_.update([&](ViewStatus& status) {
    if (status.first_pixels_s == 0) status.first_pixels_s = seconds;
    status.stage.clear();
    status.mean_samples = mean_samples;
    status.render_s = seconds;
    status.layers = std::move(names);
    status.strands_regrown = regrown;
    status.memory_bytes = ledger_.budgeted();
    status.at_rest = !waiting;
  });
}

int64_t LiveRenderer::strands_regrown() const {
  if (!loaded_ || !loaded_->geometry) return 0;
  const FrameGeometry& geometry = *loaded_->geometry;
  if (keeps_geometry_) return geometry.strands_regrown() - regrown_before_;
  // The geometry is new: after an edit, all its strands are grown again.
  const bool edited = desk_.status().edits > 0;
  return edited ? geometry.strands_grown() : geometry.strands_regrown();
}

}  // namespace pelage
