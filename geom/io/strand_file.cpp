// SPDX-License-Identifier: Apache-2.0
#include "geom/io/strand_file.h"

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "geom/interchange/read_budget.h"
#include "geom/io/alembic_strands.h"
#include "geom/io/strand_formats.h"
#include "geom/io/strand_repair.h"

namespace pelage {
namespace {

struct Format {
  const char* ending;
  std::unique_ptr<RawStrands> (*open)(const std::filesystem::path&, const StrandReadOptions&);
  void (*write)(const std::filesystem::path&, const Strands&, bool widths);
  std::initializer_list<std::string_view> attributes;  ///< that files can hold; "*": all
  bool point_widths, root_uv;                          ///< whether files can hold them
};
const Format kFormats[] = {
    {".hair", open_hair, write_hair, {"color", "transparency", "opacity"}, true, false},
    {".tfx", open_tfx, write_tfx, {"color", "transparency", "opacity", "uv", kMovable}, false, true},
    {".usda", open_usd, write_usd, {"*"}, true, true},
    {".usd", open_usd, write_usd, {"*"}, true, true},
    {".usdc", open_usd, nullptr, {"*"}, true, true},
    {".usdz", open_usd, nullptr, {"*"}, true, true},
    {".abc", open_alembic, write_alembic, {"*"}, true, true}};

const Format* find_format(const std::filesystem::path& path) {
  const std::string ending = lower_extension(path);
  for (const Format& format : kFormats) {
    if (ending == format.ending) return &format;
  }
  return nullptr;
}

const Format& format_of(const std::filesystem::path& path, ErrorKind kind) {
  if (const Format* format = find_format(path)) return *format;
  throw Error(kind, {path.string(), 0, 0}, std::string("expected a strand file ending in ") + kStrandEndings);
}

constexpr size_t kChunk = 4096;

bool widths_vary(const Strands& strands) {
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const uint32_t first = strands.first_point(s);
    for (uint32_t p = first; p < first + strands.strand_points(s); ++p) {
      if (strands.radius(p) != strands.radius(first)) return true;
    }
  }
  return false;
}

bool is_usual(const StrandAttribute& movable, const Strands& strands) {
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const uint32_t first = strands.first_point(s);
    for (uint32_t p = first; p < first + strands.strand_points(s); ++p) {
      float value = 0;
      attribute_at(movable, s, p, 1, &value);
      if (value != usually_movable(strands, s, p)) return false;
    }
  }
  return true;
}

/// Max memory that read_strands() uses for strands that stay in their file until then.
int64_t reading_bytes(const RawStrands& raw) {
  const size_t points = raw.first_point(raw.strand_count);
  size_t floats = 4 * points;
  for (const StrandAttribute& attribute : raw.attributes) {
    const size_t count = attribute.frequency == AttributeClass::kPerPoint    ? points
                         : attribute.frequency == AttributeClass::kPerStrand ? raw.strand_count
                                                                             : 1;
    floats += count * static_cast<size_t>(attribute.components);
  }
  const size_t bytes =
      floats * sizeof(float) + raw.strand_count * (sizeof(uint32_t) + sizeof(uint64_t) + sizeof(V2f));
  return static_cast<int64_t>(bytes + bytes / 2);
}

}  // namespace

bool is_strand_file(const std::filesystem::path& path) { return find_format(path) != nullptr; }

StrandFile read_strands(const std::filesystem::path& path, const StrandReadOptions& options) {
  return read_strands(AssetPath{path, {}}, options);
}

StrandFile read_strands(const AssetPath& asset, const StrandReadOptions& options) {
  const std::unique_ptr<RawStrands> raw = open_raw_strands(asset, options);
  ReadBudget(options.max_bytes).charge(reading_bytes(*raw), {raw->file.path().string(), 0, 0});
  StrandArrays arrays = raw->take_all();
  const float stated = stated_width(*raw, options);
  const float width = stated > 0 ? stated : assumed_width(arrays);
  StrandFile result = finish_strands(std::move(arrays), *raw, width);
  result.warnings = raw->warnings;
  if (!raw->has_widths && !(stated > 0)) result.assumed_width = width;
  return result;
}

std::unique_ptr<RawStrands> open_raw_strands(const std::filesystem::path& path,
                                             const StrandReadOptions& options) {
  return format_of(path, ErrorKind::kInput).open(path, options);
}

void write_strands(const std::filesystem::path& path, const Strands& strands, bool widths) {
  const Format& format = format_of(path, ErrorKind::kFailed);
  if (!format.write) fail_to_write(path, "USD is written as text; name the file .usda");
  format.write(path, strands, widths);
}

std::string what_is_lost(const std::filesystem::path& path, const Strands& strands) {
  const Format& format = format_of(path, ErrorKind::kFailed);
  std::vector<std::string> lost;
  if (!format.point_widths && widths_vary(strands))
    lost.push_back("widths that vary along strands (each strand gets its largest)");
  if (!format.root_uv && !strands.arrays().root_uv.empty() && !strands.has_roots())
    lost.push_back("texture coordinates of roots");
  for (const StrandAttribute& attribute : strands.attributes()) {
    const auto holds = [&](std::string_view name) {
      return std::find(format.attributes.begin(), format.attributes.end(), name) != format.attributes.end();
    };
    if (holds("*") || holds(attribute.name)) continue;
    if (attribute.name != kMovable) lost.push_back("the attribute " + attribute.name);
    if (attribute.name == kMovable && !is_usual(attribute, strands))
      lost.push_back("which points are fixed, other than the roots");
  }
  if (format.write == write_alembic) {
    for (const std::string& name : lost_alembic_attributes(strands, alembic_facts(path, true)))
      lost.push_back("the attribute " + name);
  }
  std::string text;
  for (const std::string& one : lost) text += (text.empty() ? "" : ", ") + one;
  return text;
}

void FileWindows::read_bytes(uint64_t offset, void* to, size_t count) {
  if (count > kBytes / 2) return file_.read_bytes(offset, to, count);
  Window* oldest = &windows_[0];
  for (Window& window : windows_) {
    if (offset >= window.begin && offset + count <= window.begin + window.bytes.size()) {
      window.used = ++uses_;
      window.answered_more = true;
      std::memcpy(to, window.bytes.data() + (offset - window.begin), count);
      return;
    }
    if (window.used < oldest->used) oldest = &window;
  }
  // The strands of a leaf may be anywhere in the file.
  const size_t size = oldest->answered_more ? kBytes : std::max(kFewBytes, 2 * count);
  oldest->begin = offset;
  oldest->used = ++uses_;
  oldest->answered_more = false;
  oldest->bytes.resize(static_cast<size_t>(std::min<uint64_t>(size, file_.size() - offset)));
  file_.read_bytes(offset, oldest->bytes.data(), oldest->bytes.size());
  std::memcpy(to, oldest->bytes.data(), count);
}

void read_point_parts(FileWindows& file, uint64_t offset, int components, size_t count, float* points) {
  const size_t n = static_cast<size_t>(components);
  std::vector<float> chunk(std::min(kChunk, count) * n);
  for (size_t begin = 0; begin < count; begin += kChunk) {
    const size_t size = std::min(kChunk, count - begin);
    file.read(offset + begin * n * sizeof(float), std::span(chunk.data(), size * n));
    for (size_t i = 0; i < size; ++i) std::copy_n(&chunk[i * n], n, points + (begin + i) * 4);
  }
}

void write_per_point(AtomicFile& file, const Strands& strands, int components,
                     const std::function<void(size_t, size_t, float*)>& value) {
  const size_t n = static_cast<size_t>(components);
  std::vector<float> chunk;
  chunk.reserve(kChunk * n);
  const auto flush = [&] {
    file.write(std::as_bytes(std::span(chunk)));
    chunk.clear();
  };
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const uint32_t end = strands.first_point(s) + strands.strand_points(s);
    for (uint32_t p = strands.first_point(s); p < end; ++p) {
      chunk.resize(chunk.size() + n);
      value(s, p, &chunk[chunk.size() - n]);
      if (chunk.size() >= kChunk * n) flush();
    }
  }
  flush();
}

void attribute_at(const StrandAttribute& attribute, size_t strand, size_t point, int components, float* out) {
  size_t index = 0;
  if (attribute.frequency == AttributeClass::kPerStrand) index = strand;
  if (attribute.frequency == AttributeClass::kPerPoint) index = point;
  const float* values = &attribute.values[index * static_cast<size_t>(attribute.components)];
  for (int c = 0; c < components; ++c) out[c] = values[std::min(c, attribute.components - 1)];
}

void append_places(const RawStrands& raw, size_t begin, size_t end, StrandArrays& arrays) {
  const uint32_t before = arrays.first_point.back();
  for (size_t s = begin; s < end; ++s) {
    arrays.ids.push_back(s);
    arrays.first_point.push_back(before + raw.first_point(s + 1) - raw.first_point(begin));
  }
}

void append_values(FileWindows& file, uint64_t offset, size_t count, StrandAttribute& attribute) {
  const size_t before = attribute.values.size(), floats = count * static_cast<size_t>(attribute.components);
  attribute.values.resize(before + floats);
  file.read(offset, std::span(attribute.values).subspan(before));
}

float stated_width(const RawStrands& raw, const StrandReadOptions& options) {
  if (raw.file_width > 0 && raw.file_width <= std::numeric_limits<float>::max()) return raw.file_width;
  return options.default_width.value_or(0.0f);
}

StrandFile finish_strands(StrandArrays arrays, const RawStrands& raw, float width) {
  StrandFile result;
  result.format = raw.format;
  if (!raw.has_widths) {
    for (size_t i = 3; i < arrays.points.size(); i += 4) arrays.points[i] = 0.5f * width;
  }
  result.repairs = repair_strands(arrays, width);
  result.strands = Strands(std::move(arrays));
  return result;
}

void fail_to_write(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorKind::kFailed, {path.string(), 0, 0}, why);
}

}  // namespace pelage
