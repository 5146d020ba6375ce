// SPDX-License-Identifier: Apache-2.0
// Tested in tests/view/live_renderer_test.cpp.
#include "view/picture.h"

#include <algorithm>
#include <chrono>

namespace pelage {
namespace {

constexpr double kWanted_s = 5;  // a page asks for its layers several times a second

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::string layer_of(const std::string& channel) {
  if (channel.size() == 1 && std::string("RGBA").find(channel) != std::string::npos) return "beauty";
  const size_t dot = channel.rfind('.');
  return dot == std::string::npos ? channel : channel.substr(0, dot);
}

std::map<std::string, std::vector<ExrChannel>> film_layers(
    const Film& film, const std::function<bool(const std::string&)>& wanted,
    std::vector<std::string>* names) {
  if (names) {
    for (const ExrChannel& channel : film.exr_rows(0, 0)) {
      const std::string layer = layer_of(channel.name);
      if (std::find(names->begin(), names->end(), layer) == names->end()) names->push_back(layer);
    }
  }
  std::map<std::string, std::vector<ExrChannel>> layers;
  const auto accepts = [&](const std::string& channel) { return wanted(layer_of(channel)); };
  for (ExrChannel& channel : film.exr_pixels({0, 0, film.width(), film.height()}, accepts))
    layers[layer_of(channel.name)].push_back(std::move(channel));
  return layers;
}

ViewStatus ViewDesk::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::shared_ptr<const Picture> ViewDesk::picture() const {
  const std::lock_guard lock(mutex_);
  return picture_;
}

void ViewDesk::publish(Picture picture) {
  const std::lock_guard lock(mutex_);
  picture.version = ++version_;
  picture_ = std::make_shared<const Picture>(std::move(picture));
}

void ViewDesk::publish(Picture picture, std::unique_ptr<const FinishedFrame> frame) {
  const std::lock_guard lock(frame_mutex_);
  publish(std::move(picture));
  frame_ = std::move(frame);
  frame_version_ = this->picture()->version;
}

void ViewDesk::discard_frame() {
  const std::lock_guard lock(frame_mutex_);
  frame_ = nullptr;
}

std::shared_ptr<const Picture> ViewDesk::with_layer(const std::string& layer) {
  std::shared_ptr<const Picture> last;
  {
    const std::lock_guard lock(mutex_);
    const bool exists =
        std::find(status_.layers.begin(), status_.layers.end(), layer) != status_.layers.end();
    if (exists) wanted_[layer] = now_s();
    last = picture_;
  }
  if (!last || last->layers.contains(layer)) return last;
  std::map<std::string, std::vector<ExrChannel>> found;
  uint64_t version = 0;
  with_frame([&](const FinishedFrame& frame) {
    found = film_layers(frame.result.film, [&](const std::string& name) { return name == layer; });
    version = frame_version_;
  });
  if (version != last->version || found.empty()) return nullptr;
  Picture more = *last;
  more.layers.merge(found);
  const auto result = std::make_shared<const Picture>(std::move(more));
  const std::lock_guard lock(mutex_);
  if (picture_ == last) picture_ = result;
  return result;
}

bool ViewDesk::is_wanted(const std::string& layer) const {
  const std::lock_guard lock(mutex_);
  const auto found = wanted_.find(layer);
  return layer == "beauty" || (found != wanted_.end() && now_s() - found->second < kWanted_s);
}

}  // namespace pelage
