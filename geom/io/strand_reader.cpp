// SPDX-License-Identifier: Apache-2.0
#include "geom/io/strand_reader.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "geom/io/file_transform.h"
#include "geom/io/strand_formats.h"
#include "geom/io/strand_repair.h"

namespace pelage {
namespace {

constexpr uint32_t kPointsAtOnce = 1 << 16;

/// Calls visit(begin, end) for ranges of strands that cover the file, each with some ten thousand points or a
/// single strand.
template <class Visit>
void for_each_range(const RawStrands& raw, const Job& job, const Visit& visit) {
  for (size_t begin = 0; begin < raw.strand_count;) {
    job.check_stop();
    size_t end = begin + 1;
    while (end < raw.strand_count && raw.first_point(end + 1) - raw.first_point(begin) <= kPointsAtOnce)
      ++end;
    visit(begin, end);
    begin = end;
  }
}

}  // namespace

StrandReader::StrandReader(const AssetPath& asset, const StrandReadOptions& options, const M44f& to_scene)
    : raw_(open_raw_strands(asset, options)), to_scene_(to_scene), width_(stated_width(*raw_, options)) {
  if (raw_->file_width > 0) width_ *= length_factor(to_scene_);
}
StrandReader::~StrandReader() = default;
StrandReader::StrandReader(StrandReader&&) noexcept = default;

size_t StrandReader::strands_in_file() const { return raw_->strand_count; }
size_t StrandReader::points_in_file() const { return raw_->first_point(raw_->strand_count); }
CurveBasis StrandReader::basis() const { return raw_->basis; }
std::span<const StrandAttribute> StrandReader::attributes() const { return raw_->attributes; }

void StrandReader::append(size_t begin, size_t end, FileWindows& windows, StrandArrays& arrays) const {
  const size_t first = arrays.points.size();
  raw_->append(begin, end, windows, arrays);
  if (to_scene_ == M44f()) return;
  const float radius_factor = length_factor(to_scene_);
  for (size_t i = first; i + 3 < arrays.points.size(); i += 4) {
    float* p = &arrays.points[i];
    const V3f point = V3f(p[0], p[1], p[2]) * to_scene_;
    std::copy_n(&point.x, 3, p);
    p[3] *= radius_factor;
  }
}

/// An unstated width depends on the size of all strands together.
void StrandReader::find_width(const Job& job) {
  if (width_ > 0) return;
  Box3f box;
  FileWindows windows(raw_->file);
  for_each_range(*raw_, job, [&](size_t begin, size_t end) {
    StrandArrays arrays = raw_->empty();
    append(begin, end, windows, arrays);
    box.extendBy(usable_box(arrays));
  });
  width_ = assumed_width(box);
}

void StrandReader::scan(const Job& job, const Visit& visit) {
  for (const std::string& warning : raw_->warnings) job.progress.warn(warning);
  find_width(job);
  for_each_strands(job, [&](const StrandFile& read) {
    repairs_.dropped += read.repairs.dropped;
    repairs_.repaired += read.repairs.repaired;
    const size_t first = count_;
    note(read.strands);
    if (count_ > first) visit(first, read.strands);
  });
}

void StrandReader::read_all(const Job& job, const Visit& visit) const {
  size_t first = 0;
  for_each_strands(job, [&](const StrandFile& read) {
    if (read.strands.strand_count() > 0) visit(first, read.strands);
    first += read.strands.strand_count();
  });
  if (first != count_) fail_changed();
}

void StrandReader::for_each_strands(const Job& job,
                                    const std::function<void(const StrandFile&)>& visit) const {
  FileWindows windows(raw_->file);
  for_each_range(*raw_, job, [&](size_t begin, size_t end) {
    StrandArrays arrays = raw_->empty();
    append(begin, end, windows, arrays);
    visit(finish_strands(std::move(arrays), *raw_, width_));
  });
}

void StrandReader::fail_changed() const {
  throw Error(ErrorKind::kFailed, {raw_->file.path().string(), 0, 0}, "changed while it was in use");
}

/// Records positions and lengths of usable strands, once these are not the same for all.
void StrandReader::note(const Strands& strands) {
  for (size_t s = 0; s < strands.strand_count(); ++s, ++count_) {
    const auto place = static_cast<uint32_t>(strands.id(s));
    if (places_.empty() && place != count_) {
      places_.resize(count_);
      std::iota(places_.begin(), places_.end(), 0u);
    }
    if (!places_.empty() || place != count_) places_.push_back(place);
    const uint32_t points = strands.strand_points(s);
    max_points_ = std::max(max_points_, points);
    if (count_ == 0) common_points_ = points;
    if (points_.empty() && points != common_points_) points_.assign(count_, common_points_);
    if (!points_.empty() || points != common_points_) points_.push_back(points);
  }
}

Strands StrandReader::read(std::span<const uint32_t> strands) const {
  StrandArrays arrays = raw_->empty();
  FileWindows windows(raw_->file);
  for (size_t i = 0; i < strands.size();) {
    size_t end = i + 1;
    while (end < strands.size() && place(strands[end]) == place(strands[end - 1]) + 1) ++end;
    append(place(strands[i]), place(strands[end - 1]) + 1, windows, arrays);
    i = end;
  }
  StrandFile read = finish_strands(std::move(arrays), *raw_, width_);
  bool same = read.strands.strand_count() == strands.size();
  for (size_t i = 0; same && i < strands.size(); ++i)
    same = read.strands.strand_points(i) == points(strands[i]);
  if (!same) fail_changed();
  return std::move(read.strands);
}

size_t StrandReader::bytes() const {
  return raw_->bytes() + (points_.capacity() + places_.capacity()) * sizeof(uint32_t);
}

}  // namespace pelage
