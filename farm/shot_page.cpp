// SPDX-License-Identifier: Apache-2.0
#include "farm/shot_page.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/counted.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory_budget.h"
#include "base/visible_text.h"
#include "image/display_image.h"
#include "image/exr_file.h"
#include "image/view_transform.h"

namespace pelage {
namespace {

constexpr int kThumbnailWidth = 240;
constexpr size_t kLogLines = 6, kLogBytes = 4000;

constexpr const char* kStyle = R"(
body{font:14px/1.45 system-ui,sans-serif;margin:2em auto;max-width:1100px;padding:0 1em;background:#fafafa;color:#222}
h1{font-size:1.5em;margin:0}h2{font-size:1.1em;margin:1.6em 0 .5em}small,.dim{color:#666}
.bar{display:flex;height:14px;border-radius:4px;overflow:hidden;background:#ddd;margin:.7em 0}
.done{background:#3a8a4d}.running{background:#2f6fc1}.queued{background:#d59b1c}.waiting{background:#c9c9c9}
.failed,.lost{background:#c23b32}.cancelled{background:#8a6d8a}
.key i{display:inline-block;width:.8em;height:.8em;border-radius:2px;margin:0 .3em 0 1em}.key{margin-left:-1em}
.frames{display:grid;grid-template-columns:repeat(auto-fill,minmax(250px,1fr));gap:12px}
.frame{background:#fff;border:1px solid #ddd;border-radius:6px;padding:8px}
.frame img,.none{width:100%;display:block;border-radius:3px;background:#eee}.none{height:120px}
.grid{display:grid;gap:2px;margin:6px 0}.grid a{height:9px;border-radius:1px;display:block}
table{border-collapse:collapse;width:100%;background:#fff}td,th{border-bottom:1px solid #ddd;padding:4px 8px;text-align:left}
pre{margin:.3em 0;white-space:pre-wrap;background:#f1f1f1;padding:6px;border-radius:4px}
)";

std::string html_escaped(std::string_view text) {
  std::string result;
  for (const char c : visible(text)) {
    if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '&')
      result += "&amp;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

std::string css_class(TaskStage stage) {
  return stage == TaskStage::kQueuedAgain ? "queued" : std::string(stage_name(stage));
}

std::string hours(double seconds) {
  const auto s = static_cast<int64_t>(seconds + 0.5);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string details(const TaskState& task) {
  std::string text(stage_name(task.stage));
  if (task.starts > 0) text += fmt::format(", {} on {}", hours(task.busy_s), task.host);
  if (task.cpu_s > 0) text += fmt::format(", {} of CPU time", hours(task.cpu_s));
  if (task.peak_bytes > 0) text += ", " + memory_text(task.peak_bytes);
  if (task.starts > 1) text += fmt::format(", started {} times", task.starts);
  if (task.stage == TaskStage::kFailed || task.stage == TaskStage::kQueuedAgain)
    text += fmt::format(", exit code {}", task.exit_code);
  return text;
}

/// The tasks of a frame, in the order of the plan.
struct ShotFrame {
  std::vector<size_t> renders;
  std::optional<size_t> merge;

  /// The task that finishes the frame.
  size_t last() const { return merge ? *merge : renders.front(); }
};

std::map<int, ShotFrame> frames_of(const ShotState& shot) {
  std::map<int, ShotFrame> frames;
  for (size_t i = 0; i < shot.plan.tasks.size(); ++i) {
    const FarmTask& task = shot.plan.tasks[i];
    if (!task.frame) continue;
    if (task.kind() == "merge") {
      frames[*task.frame].merge = i;
    } else {
      frames[*task.frame].renders.push_back(i);
    }
  }
  std::erase_if(frames, [](const auto& item) { return item.second.renders.empty(); });
  return frames;
}

/// The state of a frame: that of its least finished task.
TaskStage stage_of(const ShotState& shot, const ShotFrame& frame) {
  constexpr TaskStage kOrder[] = {TaskStage::kFailed,      TaskStage::kLost,    TaskStage::kCancelled,
                                  TaskStage::kQueuedAgain, TaskStage::kRunning, TaskStage::kWaiting};
  if (shot.tasks[frame.last()].stage == TaskStage::kDone) return TaskStage::kDone;
  for (const TaskStage stage : kOrder) {
    const auto has = [&](size_t i) { return shot.tasks[i].stage == stage; };
    if (std::any_of(frame.renders.begin(), frame.renders.end(), has) || (frame.merge && has(*frame.merge)))
      return stage;
  }
  return TaskStage::kWaiting;
}

size_t columns_of(const ShotState& shot, const ShotFrame& frame) {
  size_t columns = 0;
  for (const size_t i : frame.renders) {
    const auto& region = shot.plan.tasks[i].region;
    columns += !region || region->y0 == 0;
  }
  return std::max<size_t>(1, columns);
}

std::string frame_html(const ShotState& shot, int number, const ShotFrame& frame,
                       const PagePictures& pictures) {
  const auto picture = pictures.find(number);
  double busy_s = 0, cpu_s = 0;
  int64_t peak = 0;
  int starts = 0;
  std::string grid;
  for (const size_t i : frame.renders) {
    const TaskState& task = shot.tasks[i];
    busy_s += task.busy_s;
    cpu_s += task.cpu_s;
    peak = std::max(peak, task.peak_bytes);
    starts += std::max(0, task.starts - 1);
    grid += fmt::format("<a class={} href=\"{}\" title=\"{}: {}\"></a>", css_class(task.stage),
                        html_escaped(task.log), shot.plan.tasks[i].name, html_escaped(details(task)));
  }
  const TaskStage stage = stage_of(shot, frame);
  std::string html = fmt::format(
      "<div class=frame>{}\n",
      picture == pictures.end()
          ? "<div class=none></div>"
          : fmt::format("<img src=\"{}\" alt=\"frame {}\">", html_escaped(picture->second), number));
  html += fmt::format("<div class=grid style=\"grid-template-columns:repeat({},1fr)\">{}</div>\n",
                      columns_of(shot, frame), grid);
  html += fmt::format("<b>{}</b> {}", number, stage_name(stage));
  if (starts > 0) html += fmt::format(" <small>(started again {})</small>", counted(starts, "time"));
  if (busy_s > 0) html += fmt::format("<br><small>{} of machine time", hours(busy_s));
  if (cpu_s > 0) html += fmt::format(", {} of CPU time", hours(cpu_s));
  if (peak > 0) html += ", max " + memory_text(peak);
  if (busy_s > 0) html += "</small>";
  return html + "</div>\n";
}

std::string problems_html(const ShotState& shot, const std::filesystem::path& folder) {
  std::string rows;
  for (size_t i = 0; i < shot.tasks.size(); ++i) {
    const TaskState& task = shot.tasks[i];
    const bool bad = task.stage == TaskStage::kFailed || task.stage == TaskStage::kLost ||
                     task.stage == TaskStage::kCancelled || task.stage == TaskStage::kQueuedAgain;
    if (!bad && task.starts < 2) continue;
    rows += fmt::format("<tr><td><a href=\"{}\">{}</a><td>{}<td>{}", html_escaped(task.log),
                        shot.plan.tasks[i].name, html_escaped(details(task)),
                        task.stage == TaskStage::kFailed
                            ? "<pre>" + html_escaped(end_of_log(folder / task.log)) + "</pre>"
                            : "");
  }
  if (rows.empty()) return {};
  return "<h2>Failures and restarts</h2>\n<table><tr><th>task<th>state<th>end of its log" + rows +
         "</table>\n";
}

std::string summary_html(const ShotState& shot) {
  std::string bar, key;
  for (int s = 0; s <= static_cast<int>(TaskStage::kLost); ++s) {
    const auto stage = static_cast<TaskStage>(s);
    const int64_t count = shot.count(stage);
    if (count == 0) continue;
    bar += fmt::format("<i class={} style=\"flex:{}\"></i>", css_class(stage), count);
    key += fmt::format("<i class={}></i>{} {}", css_class(stage), count, stage_name(stage));
  }
  double busy_s = 0, cpu_s = 0;
  int64_t peak = 0;
  for (const TaskState& task : shot.tasks) {
    busy_s += task.busy_s;
    cpu_s += task.cpu_s;
    peak = std::max(peak, task.peak_bytes);
  }
  std::string text =
      fmt::format("<div class=bar>{}</div><div class=key>{}</div><p>{} of machine time, {} of CPU time", bar,
                  key, hours(busy_s), hours(cpu_s));
  if (peak > 0) text += "; max memory of a task " + memory_text(peak);
  if (const uint64_t bytes = shot.plan.estimate.render_bytes; bytes > 0)
    text += ", reserved " + memory_text(static_cast<int64_t>(bytes));
  return text + "</p>\n";
}

}  // namespace

void write_thumbnail(const std::filesystem::path& picture, const std::filesystem::path& png, int width) {
  ExrReader reader(picture);
  const ExrPart& part = reader.parts().front();
  const int columns = part.data.width(), rows = part.data.height();
  const int small = std::min(width, columns);
  const int high = std::max(1, static_cast<int>(int64_t{rows} * small / columns));
  std::array<size_t, 3> channels{};
  for (size_t c = 0; c < 3; ++c) {
    const std::string name(1, "RGB"[c]);
    const auto found = std::find_if(part.channels.begin(), part.channels.end(),
                                    [&](const ExrChannelInfo& info) { return info.name == name; });
    if (found == part.channels.end())
      throw Error(ErrorKind::kInput, {picture.string(), 0, 0}, "has no channel " + name);
    channels[c] = static_cast<size_t>(found - part.channels.begin());
  }
  DisplayImage image{small, high, {}};
  for (int y = 0; y < high; ++y) {
    const int top = static_cast<int>(int64_t{rows} * y / high);
    const int bottom = std::max(top + 1, static_cast<int>(int64_t{rows} * (y + 1) / high));
    const auto stride = static_cast<size_t>(columns), strip = stride * static_cast<size_t>(bottom - top);
    std::vector<float> words(3 * strip);
    std::vector<ExrRows> to;
    for (size_t c = 0; c < 3; ++c) to.push_back({channels[c], &words[c * strip], stride});
    reader.read(0, part.data.y0 + top, part.data.y0 + bottom, to);
    for (int x = 0; x < small; ++x) {
      const int left = static_cast<int>(int64_t{columns} * x / small);
      const int right = std::max(left + 1, static_cast<int>(int64_t{columns} * (x + 1) / small));
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (int j = 0; j < bottom - top; ++j) {
          for (int i = left; i < right; ++i)
            sum += words[c * strip + static_cast<size_t>(j) * stride + static_cast<size_t>(i)];
        }
        image.pixels.push_back(view_byte(static_cast<float>(sum / ((bottom - top) * (right - left)))));
      }
    }
  }
  write_display_image(png, image, Links::kReplace);
}

namespace {

/// Whether a file belongs to the owner of the shot. A plan of somebody else must not show pictures of the
/// user who looks at it.
bool belongs_to(const ShotState& shot, const std::filesystem::path& picture) {
  struct stat info {};
  return ::lstat(picture.c_str(), &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == shot.owner;
}

}  // namespace

PagePictures update_thumbnails(const ShotState& shot, const std::filesystem::path& folder) {
  PagePictures pictures;
  for (const auto& [number, frame] : frames_of(shot)) {
    if (shot.tasks[frame.last()].stage != TaskStage::kDone) continue;
    const std::filesystem::path picture = shot.plan.folder / shot.plan.tasks[frame.last()].output;
    const std::string name = fmt::format("thumbs/{:04}.png", number);
    std::error_code error;
    if (is_display_image(picture)) {
      pictures[number] = std::filesystem::relative(picture, folder, error).string();
      continue;
    }
    const auto made = std::filesystem::last_write_time(folder / name, error);
    const bool fresh = !error && made >= std::filesystem::last_write_time(picture, error) && !error;
    try {
      if (!belongs_to(shot, picture)) continue;
      make_own_folder(folder / "thumbs");
      if (!fresh) write_thumbnail(picture, folder / name, kThumbnailWidth);
      pictures[number] = name;
    } catch (const Error&) {
      // The page then has no picture of this frame.
    }
  }
  return pictures;
}

std::string end_of_log(const std::filesystem::path& log) {
  std::string text;
  try {
    const OpenFile file(log, OpenFile::Links::kRefuse);
    const size_t skipped = file.bytes() - std::min(file.bytes(), kLogBytes);
    text.resize(file.bytes() - skipped);
    const ssize_t read = ::pread(file.descriptor(), text.data(), text.size(), static_cast<off_t>(skipped));
    text.resize(static_cast<size_t>(std::max<ssize_t>(0, read)));
  } catch (const Error&) {
    return {};
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  size_t begin = text.size();
  for (size_t lines = 0; begin > 0 && lines < kLogLines; ++lines) {
    const size_t line = text.rfind('\n', begin - 1);
    begin = line == std::string::npos ? 0 : line;
  }
  return text.substr(begin < text.size() && text[begin] == '\n' ? begin + 1 : begin);
}

std::string shot_page(const ShotState& shot, const std::filesystem::path& folder,
                      const PagePictures& pictures, int64_t now) {
  const bool over = shot.count(TaskStage::kDone) == static_cast<int64_t>(shot.tasks.size());
  std::string name = folder.filename().string();
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=en><meta charset=utf-8>{}<title>{} - Pelage "
      "farm</title>\n<style>{}</style>\n"
      "<h1>{}</h1><small>{} tasks in {}; state of {:%Y-%m-%d %H:%M:%S} UTC</small>\n",
      over ? "" : "<meta http-equiv=refresh content=20>", html_escaped(name), kStyle, html_escaped(name),
      shot.tasks.size(), html_escaped(shot.plan.folder.string()), fmt::gmtime(static_cast<std::time_t>(now)));
  html += summary_html(shot) + problems_html(shot, folder) + "<h2>Frames</h2>\n<div class=frames>\n";
  for (const auto& [number, frame] : frames_of(shot)) html += frame_html(shot, number, frame, pictures);
  return html + "</div></html>\n";
}

}  // namespace pelage
