// SPDX-License-Identifier: Apache-2.0
#include "view/view_state.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "view/scene_edit.h"

namespace pelage {
namespace {

constexpr double kWanted_s = 5;  // a page asks for its layers several times a second
constexpr size_t kMaxPages = 100, kMaxPageName = 40;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

ViewStatus ViewState::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::shared_ptr<const Picture> ViewState::picture() const {
  const std::lock_guard lock(mutex_);
  return picture_;
}

void ViewState::publish(Picture picture) {
  const std::lock_guard lock(mutex_);
  picture.version = ++version_;
  picture.edit = status_.edits;
  if (status_.edit) picture.frame = status_.edit->scene.frames.frames.front();
  picture_ = std::make_shared<const Picture>(std::move(picture));
}

void ViewState::publish(Picture picture, std::unique_ptr<const FinishedFrame> frame) {
  const std::lock_guard lock(frame_mutex_);
  publish(std::move(picture));
  frame_ = std::move(frame);
  frame_version_ = this->picture()->version;
}

void ViewState::discard_frame() {
  const std::lock_guard lock(frame_mutex_);
  frame_ = nullptr;
}

std::shared_ptr<const Picture> ViewState::with_layers(const std::vector<std::string>& layers) {
  std::shared_ptr<const Picture> last;
  {
    const std::lock_guard lock(mutex_);
    for (const std::string& layer : layers) {
      const auto& names = status_.layers;
      if (std::find(names.begin(), names.end(), layer) != names.end()) wanted_[layer] = now_s();
    }
    last = picture_;
  }
  if (!last) return nullptr;
  std::set<std::string> missing;
  for (const std::string& layer : layers) {
    if (!last->layers.contains(layer)) missing.insert(layer);
  }
  if (missing.empty()) return last;
  std::map<std::string, std::vector<ExrChannel>> found;
  uint64_t version = 0;
  with_frame([&](const FinishedFrame& frame) {
    found = film_layers(frame.result.film, [&](const std::string& name) { return missing.contains(name); });
    version = frame_version_;
  });
  if (version != last->version || found.size() != missing.size()) return nullptr;
  Picture more = *last;
  more.layers.merge(found);
  const auto result = std::make_shared<const Picture>(std::move(more));
  const std::lock_guard lock(mutex_);
  if (picture_ == last) picture_ = result;
  return result;
}

void ViewState::see_page(const std::string& page) {
  if (page.empty() || page.size() > kMaxPageName) return;
  const std::lock_guard lock(mutex_);
  std::erase_if(pages_, [](const auto& seen) { return now_s() - seen.second > kWanted_s; });
  if (pages_.size() < kMaxPages || pages_.contains(page)) pages_[page] = now_s();
}

size_t ViewState::pages() const {
  const std::lock_guard lock(mutex_);
  return static_cast<size_t>(std::count_if(
      pages_.begin(), pages_.end(), [](const auto& seen) { return now_s() - seen.second <= kWanted_s; }));
}

bool ViewState::is_wanted(const std::string& layer) const {
  const std::lock_guard lock(mutex_);
  const auto found = wanted_.find(layer);
  return layer == "beauty" || (found != wanted_.end() && now_s() - found->second < kWanted_s);
}

}  // namespace pelage
