// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "base/ledger.h"
#include "base/parallel.h"
#include "render/frame/frame_result.h"
#include "view/scene_edit.h"
#include "view/stage_progress.h"
#include "view/view_state.h"

namespace pelage {

struct FrameOptions;
struct FrameSettings;

/// Renders the last edit of a scene on a thread of its own, and publishes its pictures on a ViewState. Keeps
/// the world and its geometry between edits, and makes only those parts again that depend on the change. An
/// edit ends the render of the edit before it. Thread safety: all members may be called from any thread.
class LiveRenderer {
 public:
  /// `threads`: as in Workers. The state must outlive the renderer.
  LiveRenderer(ViewState& state, int threads);
  /// Ends the render and frees the finished frame on the state.
  ~LiveRenderer();
  LiveRenderer(const LiveRenderer&) = delete;
  LiveRenderer& operator=(const LiveRenderer&) = delete;

  /// Begins to render an edit.
  void submit(std::shared_ptr<const SceneEdit> edit);

 private:
  class Watch;
  struct Loaded;

  void run();
  void render(const std::shared_ptr<const SceneEdit>& edit);
  /// Makes those assets and parts of the world of an edit that `redo` requires.
  void load(const SceneEdit& edit, Redo redo, const Job& job);
  /// Frees everything that is kept between edits.
  void forget();
  void render_loaded(const SceneEdit& edit, const Job& job);
  FrameResult trace(const Job& job, const FrameOptions& options);
  void finish(const SceneEdit& edit, FrameResult result);
  /// Answers what clients ask about the pixels of the picture. `settings`: with which a pixel was rendered;
  /// empty for those of the scene.
  void answer_questions(const std::function<FrameSettings(int x, int y)>& settings = {});
  /// Takes the chunks out of the geometry, so that a new geometry can use them.
  void release_geometry();
  int64_t strands_regrown() const;
  bool must_end() const { return stopped_ || waiting_; }

  ViewState& state_;
  MemoryLedger ledger_;
  Workers workers_;
  std::atomic<bool> waiting_{false};  // next_ is not null
  std::atomic<bool> stopped_{false};
  StageProgress progress_;  // before loaded_: chunks that are kept may warn
  // Used by thread_ only.
  std::unique_ptr<Loaded> loaded_;
  bool began_ = false;   // whether an edit was rendered before
  int64_t regrown_ = 0;  // strands regrown since the edit, minus those that loaded_->geometry counts

  std::mutex mutex_;  // guards next_
  std::condition_variable changed_;
  std::shared_ptr<const SceneEdit> next_;
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace pelage
