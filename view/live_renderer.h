// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "base/ledger.h"
#include "base/parallel.h"
#include "view/picture.h"
#include "view/scene_edit.h"

namespace pelage {

class FrameWatch;

/// Renders the last edit of a scene on a thread of its own, and publishes its pictures on a ViewDesk. Keeps
/// the world and its geometry between edits, and makes only those parts again that depend on the change. An
/// edit ends the render of the edit before it. Thread safety: all members may be called from any thread.
class LiveRenderer {
 public:
  /// `threads`: as in Workers. The desk must outlive the renderer.
  LiveRenderer(ViewDesk& desk, int threads);
  /// Ends the render and frees the finished frame on the desk.
  ~LiveRenderer();
  LiveRenderer(const LiveRenderer&) = delete;
  LiveRenderer& operator=(const LiveRenderer&) = delete;

  /// Begins to render an edit.
  void submit(std::shared_ptr<const SceneEdit> edit);

 private:
  class StageProgress;
  class Watch;
  struct Loaded;

  void run();
  void render(const std::shared_ptr<const SceneEdit>& edit);
  /// Brings loaded_ to the state of an edit.
  void load(const SceneEdit& edit, const Job& job);
  void render_loaded(const SceneEdit& edit, const Job& job);
  FrameResult trace(const Job& job, FrameWatch& watch);
  void finish(const SceneEdit& edit, FrameResult result);
  int64_t strands_regrown() const;
  bool must_end() const { return stopped_ || waiting_; }

  ViewDesk& desk_;
  MemoryLedger ledger_;
  Workers workers_;
  // Used by thread_ only.
  std::unique_ptr<Loaded> loaded_;
  bool began_ = false;           // whether an edit was rendered before
  bool keeps_geometry_ = false;  // the geometry is older than the edit
  int64_t regrown_before_ = 0;   // strands regrown before the edit

  std::mutex mutex_;  // guards next_
  std::condition_variable changed_;
  std::shared_ptr<const SceneEdit> next_;
  std::atomic<bool> waiting_{false};  // next_ is not null
  std::atomic<bool> stopped_{false};
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace pelage
