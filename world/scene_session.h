// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "geom/strands.h"
#include "world/statistics.h"
#include "world/world.h"

namespace pelage {

/// A rendered frame with all that write_frame() needs. Must not outlive its SceneSession.
struct RenderedFrame {
  FrameResult result;
  FrameHeader header;
  Camera camera;
  Statistics statistics;  ///< of this frame alone; without the members of `process` that a run samples
};

/// Whether operators may run the scripts that the scene names. A script may do whatever the user may do.
enum class ScriptUse { kRefused, kAllowed };

/// A scene in the memory of a host: its values change, its coats grow, its frames are rendered, any number of
/// times. Skins and grooms that no change concerns are kept.
///
/// All members throw Error. grow() throws kStopped when `progress` is cancelled; render() then returns a
/// partial picture, or throws kStopped if there are no samples yet.
///
/// Thread safety: any thread may call any member. Calls for the same session take turns, except that set()
/// and scene() do not wait for a render: it continues with the values that it began with.
class SceneSession {
 public:
  /// Reads a scene file, but no RIB file, and sets values. `threads`: 0 means available_processors().
  explicit SceneSession(const std::filesystem::path& path, const std::vector<Override>& changes = {},
                        int threads = 0, ScriptUse scripts = ScriptUse::kRefused);
  /// Takes a document that the host has made, see make_scene().
  explicit SceneSession(Value document, const std::vector<Override>& changes = {}, int threads = 0,
                        ScriptUse scripts = ScriptUse::kRefused);
  ~SceneSession();
  SceneSession(const SceneSession&) = delete;
  SceneSession& operator=(const SceneSession&) = delete;

  /// Sets values, all or none: throws Error (kInput) and changes nothing if the scene would not be valid.
  void set(const std::vector<Override>& changes);
  /// Throws the error that set() would throw, and changes nothing.
  void check(const std::vector<Override>& changes) const;
  /// Returns the checked scene as it is now. Its `warnings` are for the user.
  std::shared_ptr<const SceneDescription> scene() const;

  /// Returns all strands of a coat, in world space and without level of detail; see grow_coat(). `frame`:
  /// empty means the first frame of the scene.
  Strands grow(const std::string& coat, std::optional<double> frame, Progress& progress);

  /// Renders a frame. `options`: a watch sees the film while it forms. Warnings go to `progress`.
  RenderedFrame render(std::optional<double> frame, Progress& progress, const FrameOptions& options = {});

  const Workers& workers() const { return workers_; }
  MemoryLedger& ledger() { return ledger_; }

 private:
  /// A document with includes and with current names of keys.
  struct Document {
    Value root;
    std::vector<Override> frames;  // the last change of `frames`, which framing a character ignores
    std::vector<Problem> warnings;
  };
  static Document read_file(const std::filesystem::path& path);
  static Document changed(Document document, const std::vector<Override>& changes);
  std::shared_ptr<const SceneDescription> checked(const Document& document) const;
  /// Brings the assets to the state of `scene`.
  Assets& assets_of(const SceneDescription& scene, const Job& job);

  const std::shared_ptr<const OperatorScripts> scripts_;  // SceneDescription::scripts
  Workers workers_;
  MemoryLedger ledger_;

  mutable std::mutex values_;  // guards the next two
  Document document_;
  std::shared_ptr<const SceneDescription> scene_;

  std::mutex work_;  // guards the next two
  std::unique_ptr<Assets> assets_;
  std::string loaded_;  // SceneDescription::hash of the assets; empty if they are incomplete
};

}  // namespace pelage
