// SPDX-License-Identifier: Apache-2.0
#include "view/live_renderer.h"

#include <algorithm>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/heap.h"
#include "base/job.h"
#include "render/frame/frame_geometry.h"
#include "render/frame/frame_watch.h"
#include "render/render_frame.h"
#include "view/why_answer.h"
#include "world/dark_lights.h"
#include "world/kept_render.h"
#include "world/world.h"

namespace pelage {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

/// All that is kept between edits. The geometry refers to the world, and the world to the assets. While there
/// is no geometry, `fur` has the chunks of the last geometry.
struct LiveRenderer::Loaded {
  Loaded(MemoryLedger& ledger, Progress& progress) : assets(ledger, &progress) {}

  std::shared_ptr<const SceneEdit> edit;  // the world shows it; null: none, and assets may be incomplete
  Assets assets;
  std::unique_ptr<World> world;
  KeptFur fur;
  std::unique_ptr<FrameGeometry> geometry;

  double frame() const { return edit->scene.frames.frames.front(); }
};

/// Publishes a picture after each pass.
class LiveRenderer::Watch final : public FrameWatch {
 public:
  Watch(LiveRenderer& renderer, const SceneEdit& edit) : renderer_(renderer), edit_(edit) {}

  void passed(const Film& film, const PassState& pass) override {
    publish(film, pass);
    answer_questions(film, pass);
  }
  std::optional<PixelBox> region() const override { return renderer_.state_.control().region(); }
  uint32_t region_version() const override { return renderer_.state_.control().region_version(); }
  uint32_t pause_version() const override { return renderer_.state_.why().asked(); }
  void paused(const Film& film, const PassState& pass) override {
    if (!renderer_.state_.why().is_waiting()) return;
    if (pass.grid > 0) publish(film, pass);  // the page must show the samples that the answer explains
    answer_questions(film, pass);
  }

 private:
  void publish(const Film& film, const PassState& pass) {
    ViewState& state = renderer_.state_;
    std::vector<std::string> names;
    Picture picture;
    picture.width = film.width();
    picture.height = film.height();
    picture.grid = pass.grid;
    picture.full = pass.full;
    picture.samples = pass.samples;
    picture.layers = film_layers(
        film, [&](const std::string& layer) { return state.is_wanted(layer); }, &names);
    state.publish(std::move(picture));
    const int64_t regrown = renderer_.strands_regrown();
    state.update([&](ViewStatus& status) {
      if (status.first_pixels_s == 0) status.first_pixels_s = seconds_since(edit_.noticed);
      status.mean_samples = pass.mean_samples;
      status.layers = std::move(names);
      status.strands_regrown = regrown;
    });
  }

  /// Explains the picture on the screen: pixels have as many samples as so far. Until the first pass of
  /// `gather` ends, the picture is a coarse one.
  void answer_questions(const Film& film, const PassState& pass) {
    const RenderScene& scene = renderer_.loaded_->world->scene;
    const bool gathers = scene.render.integrator == Integrator::kGather;
    renderer_.answer_questions([&](int x, int y) {
      if (pass.coarse || (gathers && pass.grid == 0)) return coarse_settings(scene);
      FrameSettings settings{scene.image, scene.render};
      const bool inside = x >= 0 && y >= 0 && x < film.width() && y < film.height();
      if (inside) settings.render.samples = static_cast<int>(std::max(film.samples(x, y), 1u));
      return settings;
    });
  }

  LiveRenderer& renderer_;
  const SceneEdit& edit_;
};

LiveRenderer::LiveRenderer(ViewState& state, int threads)
    : state_(state),
      workers_(threads),
      progress_(state, ledger_, [this] { return must_end(); }),
      loaded_(std::make_unique<Loaded>(ledger_, progress_)),
      thread_([this] { run(); }) {
  state_.why().on_ask([this] {
    // With the lock, so that the question is not missed between the test of the thread and its sleep.
    { const std::lock_guard lock(mutex_); }
    changed_.notify_all();
  });
}

LiveRenderer::~LiveRenderer() {
  state_.why().on_ask({});
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
  state_.discard_frame();  // its film is charged to ledger_
}

void LiveRenderer::submit(std::shared_ptr<const SceneEdit> edit) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(edit);
    waiting_ = true;
    // Clear the state after setting `waiting_`, so that the render that is ending does not report completion,
    // and before the thread takes the edit.
    state_.update([](ViewStatus& status) {
      status.at_rest = false;
      status.render_error.clear();
    });
  }
  changed_.notify_all();
}

void LiveRenderer::run() {
  while (true) {
    std::shared_ptr<const SceneEdit> edit;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return must_end() || state_.why().is_waiting(); });
      if (stopped_) return;
      if (!waiting_) {
        lock.unlock();
        answer_questions();
        continue;
      }
      edit = std::exchange(next_, nullptr);
      waiting_ = false;
    }
    const auto fail = [this](const std::string& message) {
      state_.update([&](ViewStatus& status) {
        status.stage.clear();
        if (!waiting_) status.render_error = message;
      });
    };
    try {
      render(edit);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kStopped) fail(error.what());
    } catch (const std::bad_alloc&) {
      forget();
      fail("out of memory");
    } catch (const std::exception& error) {
      forget();
      fail(error.what());
    }
  }
}

void LiveRenderer::render(const std::shared_ptr<const SceneEdit>& edit) {
  state_.update([&](ViewStatus& status) {
    status.mean_samples = status.first_pixels_s = status.render_s = 0;
    status.strands_regrown = 0;
    status.wanted_samples = edit->scene.render.samples;
    status.edits += began_;
    status.edit = edit;
    status.warnings.clear();
    for (const Problem& warning : edit->scene.warnings)
      status.warnings.push_back(to_string(warning.position) + ": " + warning.message);
    if (const auto dark = why_dark(edit->scene)) status.warnings.push_back(*dark);
  });
  began_ = true;
  progress_.reset();
  const Job job{workers_, ledger_, progress_};
  const Redo redo = loaded_->edit ? edit->redo_after(*loaded_->edit) : Redo::kAssets;
  regrown_ = loaded_->geometry ? -loaded_->geometry->strands_regrown() : 0;
  if (redo == Redo::kSampling) {
    const RenderParams& params = loaded_->world->scene.render;
    const float min_width = params.min_width();
    recompose_sampling(edit->scene, loaded_->assets, loaded_->frame(), job, *loaded_->world);
    if (params.min_width() != min_width) release_geometry();  // it has strands of the old min width
  } else if (redo > Redo::kSampling) {
    release_geometry();
    try {
      load(*edit, redo, job);
    } catch (const Error& error) {
      // Chunks kept from the last frame may occupy the memory that this frame needs.
      if (error.kind() != ErrorKind::kMemory) throw;
      state_.discard_frame();
      forget();
      load(*edit, Redo::kAssets, job);
    }
  }
  loaded_->edit = edit;
  state_.discard_frame();  // not earlier: after a mistake in an asset, the last picture stays whole
  render_loaded(*edit, job);
}

void LiveRenderer::load(const SceneEdit& edit, Redo redo, const Job& job) {
  loaded_->edit = nullptr;  // until everything is loaded
  loaded_->world = nullptr;
  if (redo == Redo::kAssets) {
    progress_.begin("read", 1);
    keep_spare_heap(edit.scene.render.memory.bytes, job.workers.thread_count());
    const MemoryCharge film = reserve_film(edit.scene, job);
    update_assets(edit.scene, job, loaded_->assets);
    progress_.end();
  } else {
    loaded_->assets.materials = load_materials(edit.scene, loaded_->assets, job);
  }
  progress_.begin("pose", 1);
  const double frame = edit.scene.frames.frames.front();
  loaded_->world = std::make_unique<World>(compose(edit.scene, loaded_->assets, frame, job));
  if (!edit.scene.camera.frame.name.empty()) {  // only now is the place of the camera known
    const CameraParams& camera = loaded_->world->camera;
    state_.update([&](ViewStatus& status) {
      status.camera.position = camera.position.at(frame);
      status.camera.look_at = camera.look_at.at(frame);
      status.camera.height = camera.orthographic ? camera.orthographic->at(frame) : 0;
    });
  }
  loaded_->assets.textures.forget_unused();
  progress_.end();
}

void LiveRenderer::forget() {
  loaded_ = nullptr;
  loaded_ = std::make_unique<Loaded>(ledger_, progress_);
}

void LiveRenderer::render_loaded(const SceneEdit& edit, const Job& job) {
  Watch watch(*this, edit);
  FrameOptions options;
  options.watch = &watch;
  FrameResult result = trace(job, options);
  if (!result.partial) finish(edit, std::move(result));
}

FrameResult LiveRenderer::trace(const Job& job, const FrameOptions& options) {
  try {
    return pelage::render(*loaded_->world, job, options, loaded_->geometry, &loaded_->fur);
  } catch (const Error& error) {
    const bool keeps = loaded_->geometry || loaded_->fur.has_frame();
    if (error.kind() != ErrorKind::kMemory || !keeps) throw;
  }
  // Chunks kept from the last frame may occupy the memory that this frame needs: the film, for example, is
  // charged before the geometry.
  release_geometry();
  loaded_->fur.free_chunks();
  return pelage::render(*loaded_->world, job, options, loaded_->geometry, &loaded_->fur);
}

void LiveRenderer::release_geometry() {
  if (!loaded_->geometry) return;
  regrown_ += loaded_->geometry->strands_regrown();
  loaded_->geometry->release(loaded_->fur, ledger_);
  loaded_->geometry = nullptr;
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
      result.film, [this](const std::string& layer) { return state_.is_wanted(layer); }, &names);
  FrameHeader header = finished_header(*loaded_->world, result, seconds);
  auto frame = std::make_unique<const FinishedFrame>(
      FinishedFrame{std::move(result), std::move(header), loaded_->world->scene.camera});
  state_.publish(std::move(picture), std::move(frame));
  const int64_t regrown = strands_regrown();
  state_.update([&](ViewStatus& status) {
    if (status.first_pixels_s == 0) status.first_pixels_s = seconds;
    status.stage.clear();
    status.mean_samples = mean_samples;
    status.render_s = seconds;
    status.layers = std::move(names);
    status.strands_regrown = regrown;
    status.memory_bytes = ledger_.budgeted();
    status.at_rest = !waiting_;
  });
}

void LiveRenderer::answer_questions(const std::function<FrameSettings(int x, int y)>& settings) {
  state_.why().answer([&](int x, int y) -> std::optional<CommandAnswer> {
    if (!loaded_->edit || !loaded_->geometry) return no_picture_answer();
    ExplainedFrame frame{loaded_->edit->scene, loaded_->assets, *loaded_->world, loaded_->geometry,
                         &loaded_->fur};
    if (settings) frame.settings = settings(x, y);
    return why_answer(frame, x, y, workers_, ledger_, [this] { return must_end(); });
  });
}

int64_t LiveRenderer::strands_regrown() const {
  return regrown_ + (loaded_->geometry ? loaded_->geometry->strands_regrown() : 0);
}

}  // namespace pelage
