// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "farm/shot_state.h"

namespace pelage {

/// Pictures of the page: paths relative to the page, by frame.
using PagePictures = std::map<int, std::string>;

/// Brings the thumbnails of all finished frames in `folder`/thumbs up to date, and returns them. Pictures
/// that cannot be read have none, nor have links and pictures that do not belong to the owner of the shot.
PagePictures update_thumbnails(const ShotState& shot, const std::filesystem::path& folder);

/// Returns a page that shows a shot: frames with thumbnails, times, memory, regions and failures. It needs no
/// server and no script. `folder`: of the shot; the ends of the logs of failed tasks are read there. `now`:
/// in seconds since 1970.
std::string shot_page(const ShotState& shot, const std::filesystem::path& folder,
                      const PagePictures& pictures, int64_t now);

/// Returns the last lines of the log of a task, for a message: at most 4,000 bytes. They may contain
/// anything.
std::string end_of_log(const std::filesystem::path& log);

/// Writes a small PNG of an EXR picture, at most `width` pixels wide, as a screen shows it. Each pixel is the
/// mean of the pixels that it covers. Reads a few rows at a time. Throws Error: kInput if the picture cannot
/// be read or has no channels R, G and B, kFailed if the PNG cannot be written.
void write_thumbnail(const std::filesystem::path& picture, const std::filesystem::path& png, int width);

}  // namespace pelage
