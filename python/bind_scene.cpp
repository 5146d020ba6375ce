// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "base/error.h"
#include "base/heap.h"
#include "base/nearest_name.h"
#include "image/display_image.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/pictures.h"
#include "python/python_job.h"
#include "python/values.h"
#include "render/frame/frame_watch.h"
#include "world/scene_session.h"
#include "world/statistics_json.h"

namespace py = pybind11;

namespace pelage {
namespace {

/// The film between two passes. Only valid during the callback that gets it.
class PassView {
 public:
  PassView(const Film& film, const PassState& state) : film_(&film), state_(state) {}
  void close() { film_ = nullptr; }
  const PassState& state() const { return state_; }
  const Film& film() const {
    if (!film_) throw std::runtime_error("a pass can only be read while its callback runs");
    return *film_;
  }

  /// Names of all layers.
  std::vector<std::string> names() const {
    std::vector<std::string> channels, names;
    film().exr_pixels({0, 0, 0, 0}, [&](const std::string& channel) {
      channels.push_back(channel);
      return false;
    });
    for (const std::string& channel : channels) {
      const std::string layer = layer_of(channel, channels);
      if (std::find(names.begin(), names.end(), layer) == names.end()) names.push_back(layer);
    }
    return names;
  }

  /// The layers of these names, which names() must have; all without names.
  py::dict layers(const std::optional<std::vector<std::string>>& wanted) const {
    const Film& shown = film();
    const PixelBox all{0, 0, shown.width(), shown.height()};
    const auto matches = [&](const std::string& channel) {
      return std::any_of(wanted->begin(), wanted->end(), [&](const std::string& layer) {
        return channel == layer || layer_of(channel, {}) == layer;
      });
    };
    return layer_arrays(wanted ? shown.exr_pixels(all, matches) : shown.exr_pixels(all), shown.width(),
                        shown.height());
  }

 private:
  const Film* film_;
  PassState state_;
};

/// The threads that run calls of a session or its callbacks. A callback must not wait for the call that waits
/// for it.
class Callers {
 public:
  /// Enters the current thread. Throws if it is among them already.
  class Entry {
   public:
    explicit Entry(Callers& callers) : callers_(callers) {
      const std::lock_guard lock(callers_.mutex_);
      if (!callers_.threads_.insert(std::this_thread::get_id()).second)
        throw std::runtime_error("a callback cannot grow or render the scene that calls it");
    }
    ~Entry() {
      const std::lock_guard lock(callers_.mutex_);
      callers_.threads_.erase(std::this_thread::get_id());
    }
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;

   private:
    Callers& callers_;
  };

 private:
  std::mutex mutex_;
  std::set<std::thread::id> threads_;
};

/// Calls back between two passes, on the thread that renders.
class PythonWatch final : public FrameWatch {
 public:
  PythonWatch(py::object callback, PythonProgress& progress, Callers& callers)
      : callback_(std::move(callback)), progress_(progress), callers_(callers) {}
  void passed(const Film& film, const PassState& state) override {
    if (progress_.cancelled()) return;
    const py::gil_scoped_acquire acquire;
    const auto view = std::make_shared<PassView>(film, state);
    try {
      const Callers::Entry entry(callers_);
      callback_(view);
    } catch (py::error_already_set&) {
      progress_.fail(std::current_exception());
    }
    view->close();
  }
  std::optional<PixelBox> region() const override { return {}; }
  uint32_t region_version() const override { return 0; }

 private:
  const py::object callback_;
  PythonProgress& progress_;
  Callers& callers_;
};

/// A session, and the calls to it that run and can be cancelled.
class Session {
 public:
  template <class Source>
  Session(const Source& source, const std::vector<Override>& changes, int threads, bool allow_scripts)
      : session_(source, changes, threads, allow_scripts ? ScriptUse::kAllowed : ScriptUse::kRefused) {}

  SceneSession& operator*() { return session_; }
  SceneSession* operator->() { return &session_; }
  Callers& callers() { return callers_; }

  void cancel() {
    const std::lock_guard lock(mutex_);
    for (PythonProgress* progress : running_) progress->stop();
  }

  void run(PythonProgress& progress, const std::function<void()>& work) {
    const Callers::Entry entry(callers_);
    const Running running(*this, progress);
    run_job(progress, work);
  }

 private:
  struct Running {
    Running(Session& owner, PythonProgress& call) : session(owner), progress(call) {
      const std::lock_guard lock(session.mutex_);
      session.running_.push_back(&progress);
    }
    ~Running() {
      const std::lock_guard lock(session.mutex_);
      std::erase(session.running_, &progress);
    }
    Session& session;
    PythonProgress& progress;
  };

  SceneSession session_;
  Callers callers_;
  std::mutex mutex_;
  std::vector<PythonProgress*> running_;
};

std::shared_ptr<Strands> grow(Session& session, const std::string& coat, std::optional<double> frame,
                              py::object callback) {
  PythonProgress progress(std::move(callback));
  std::shared_ptr<Strands> strands;
  session.run(progress, [&] { strands = std::make_shared<Strands>(session->grow(coat, frame, progress)); });
  return strands;
}

struct RenderArguments {
  std::optional<double> frame;
  std::optional<std::array<int, 4>> region;
  std::filesystem::path output;
};

std::vector<ExrChannel> channels_of(const FrameResult& result) {
  const auto& [picture, region, traced, stored] = result.window;
  const int left = region.x0 - stored.x0, top = region.y0 - stored.y0;
  return result.film.exr_pixels({left, top, left + region.width(), top + region.height()});
}

py::dict render(Session& session, const RenderArguments& arguments, const py::object& callback,
                const py::object& on_pass) {
  const std::filesystem::path& output = arguments.output;
  if (!output.empty() && output.extension() != ".exr" && !is_display_image(output))
    throw Error(ErrorKind::kArguments,
                "output: " + quote(output.string()) + " must end in .exr, .png or .jpg");
  PythonProgress progress(callback);
  std::optional<PythonWatch> watch;
  FrameOptions options;
  if (!on_pass.is_none()) options.watch = &watch.emplace(on_pass, progress, session.callers());
  if (const auto& box = arguments.region)
    options.region = PixelBox{(*box)[0], (*box)[1], (*box)[2], (*box)[3]};
  std::vector<ExrChannel> channels;
  std::string statistics;
  PixelBox region;
  bool partial = false;
  session.run(progress, [&] {
    const RenderedFrame frame = session->render(arguments.frame, progress, options);
    channels = channels_of(frame.result);
    statistics = statistics_json(frame.statistics);
    region = frame.result.window.region;
    partial = frame.result.partial;
    if (arguments.output.empty() || partial) return;
    write_frame(arguments.output, frame.header, frame.camera, frame.result,
                {session->workers(), session->ledger(), progress});
  });
  trim_heap();
  py::dict result;
  result["layers"] = layer_arrays(std::move(channels), region.width(), region.height());
  result["region"] = py::make_tuple(region.x0, region.y0, region.x1, region.y1);
  result["partial"] = partial;
  result["statistics"] = statistics;
  return result;
}

py::list warnings_of(SceneSession& session) {
  py::list lines;
  for (const Problem& warning : session.scene()->warnings)
    lines.append(to_string(warning.position) + ": " + warning.message);
  return lines;
}

py::dict names_of(SceneSession& session) {
  const auto scene = session.scene();
  py::dict names;
  names["skins"] = scene->skins.names();
  names["grooms"] = scene->grooms.names();
  names["materials"] = scene->materials.names();
  names["characters"] = scene->characters.names();
  names["lights"] = scene->lights.names();
  names["frames"] = scene->frames.frames;
  names["size"] = py::make_tuple(scene->image.width, scene->image.height);
  return names;
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<PassView, std::shared_ptr<PassView>>(module, "PassView")
      .def("layers", &PassView::layers)
      .def_property_readonly("names", &PassView::names)
      .def_property_readonly("samples", [](const PassView& v) { return v.state().samples; })
      .def_property_readonly("mean_samples", [](const PassView& v) { return v.state().mean_samples; })
      .def_property_readonly("grid", [](const PassView& v) { return v.state().grid; })
      .def_property_readonly("coarse", [](const PassView& v) { return v.state().coarse; });
  py::class_<Session, std::shared_ptr<Session>>(module, "Session")
      .def("set", [](Session& s, const py::dict& changes) { s->set(to_overrides(changes)); })
      .def("check", [](Session& s, const py::dict& changes) { s->check(to_overrides(changes)); })
      .def("cancel", &Session::cancel)
      .def("grow", grow)
      .def("render",
           [](Session& s, std::optional<double> frame, const std::optional<std::array<int, 4>>& region,
              const std::filesystem::path& output, const py::object& progress, const py::object& on_pass) {
             return render(s, {frame, region, output}, progress, on_pass);
           })
      .def_property_readonly("warnings", [](Session& s) { return warnings_of(*s); })
      .def_property_readonly("names", [](Session& s) { return names_of(*s); });
  module.def("open_scene",
             [](const std::filesystem::path& path, const py::dict& changes, int threads, bool allow_scripts) {
               return std::make_shared<Session>(path, to_overrides(changes), threads, allow_scripts);
             });
  module.def("make_scene", [](const py::dict& document, const py::dict& changes, int threads,
                              bool allow_scripts) {
    return std::make_shared<Session>(to_value(document, ""), to_overrides(changes), threads, allow_scripts);
  });
}

}  // namespace pelage
