// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "base/file.h"
#include "base/job.h"
#include "geom/curve.h"
#include "geom/strands.h"
#include "geom/view.h"
#include "world/frame_coats.h"

namespace pelage {

/// A text file for another program, which appears completely or not at all (law 6).
class ExportedText {
 public:
  explicit ExportedText(const std::filesystem::path& path) : file_(path, Links::kReplace) {}
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    if (text_.size() >= (size_t(1) << 20)) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  void flush() {
    file_.write(std::string_view(text_.data(), text_.size()));
    text_.clear();
  }
  AtomicFile file_;
  fmt::memory_buffer text_;
};

/// Returns the strands at the middle of the shutter, with one motion key.
Strands still_strands(Strands strands);

/// Returns the points of a strand as those of a uniform B-spline without phantom points: x, y, z and radius
/// of each. Linear and Catmull-Rom strands get more points, so that the B-spline is near to them.
std::vector<float> bspline_points(const Strands& strands, size_t strand);

/// Returns the number of triangles of a skin as `view` needs them, and writes them as a PLY file in text, in
/// the pose at the middle of the shutter. Writes no file if there are none.
size_t write_ply(const std::filesystem::path& path, const FrameSkin& skin, const View& view, const Job& job);
/// Cuts the faces of a cage into triangles. Returns the vertices of their corners.
std::vector<uint32_t> cage_triangles(const ControlMesh& mesh);
/// Writes the faces of a cage as triangles.
void write_ply(const std::filesystem::path& path, const ControlMesh& mesh);

}  // namespace pelage
