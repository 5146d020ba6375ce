// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <type_traits>

#include "base/file.h"
#include "geom/io/strand_formats.h"

// TressFX 4's .tfx format [TressFX]: a header of 160 bytes with the byte offsets of the arrays, 0 for missing
// ones. All strands have the same number of points; a point's fourth float is 0 if the simulation fixes it,
// else 1.

namespace pelage {
namespace {

struct TfxHeader {
  float version;
  uint32_t strand_count;
  uint32_t points_per_strand;
  uint32_t points;     ///< 4 floats per point
  uint32_t strand_uv;  ///< 2 floats per strand
  uint32_t point_uv;   ///< 2 floats per point
  uint32_t thickness;  ///< a float per strand
  uint32_t color;      ///< 4 floats per point
  uint32_t reserved[32];
};
static_assert(sizeof(TfxHeader) == 160 && std::is_trivially_copyable_v<TfxHeader>);

TfxHeader read_tfx_header(const BinaryFile& file) {
  TfxHeader header;
  file.require(0, sizeof header, 1, "bytes of header");
  file.read_bytes(0, &header, sizeof header);
  if (!(header.version >= 4 && header.version < 5))
    file.fail("is not a TressFX 4 file: its version is not 4");
  if (header.points == 0) file.fail("holds no points");
  if (header.strand_count == 0) file.fail("holds no strands");
  if (uint64_t(header.strand_count) * header.points_per_strand > std::numeric_limits<uint32_t>::max()) {
    file.fail("claims " + std::to_string(header.strand_count) + " strands of " +
              std::to_string(header.points_per_strand) + " points, more than it can hold");
  }
  if (header.points_per_strand < 2) {
    file.fail("claims " + std::to_string(header.points_per_strand) +
              " points per strand, expected at least 2");
  }
  return header;
}

void check_array(const BinaryFile& file, uint64_t offset, uint64_t count, int components, const char* what) {
  if (offset == 0) return;
  if (offset < sizeof(TfxHeader)) file.fail("its " + std::string(what) + " would overlap its header");
  file.require(offset, count, 4 * static_cast<uint64_t>(components), what);
}

float largest_radius(const Strands& strands, size_t strand) {
  float largest = 0;
  for (uint32_t i = 0; i < strands.strand_points(strand); ++i) {
    largest = std::max(largest, strands.radius(strands.first_point(strand) + i));
  }
  return largest;
}

}  // namespace

namespace {

class TfxFile final : public RawStrands {
 public:
  TfxFile(const std::filesystem::path& path, const StrandReadOptions& options)
      : RawStrands(path, "tfx", options), header_(read_tfx_header(file)) {
    strand_count = header_.strand_count;
    const size_t points = strand_count * header_.points_per_strand;
    check_array(file, header_.points, points, 4, "points");
    check_array(file, header_.strand_uv, strand_count, 2, "strand coordinates");
    check_array(file, header_.point_uv, points, 2, "point coordinates");
    check_array(file, header_.thickness, strand_count, 1, "thicknesses");
    check_array(file, header_.color, points, 4, "colours");
    has_widths = header_.thickness != 0;
    if (options.movable) attributes.push_back({kMovable, AttributeClass::kPerPoint, 1, {}});
    if (header_.point_uv) attributes.push_back({"uv", AttributeClass::kPerPoint, 2, {}});
    if (header_.color) {
      attributes.push_back({"color", AttributeClass::kPerPoint, 3, {}});
      attributes.push_back({"opacity", AttributeClass::kPerPoint, 1, {}});
    }
  }

  uint32_t first_point(size_t strand) const override {
    return static_cast<uint32_t>(strand * header_.points_per_strand);
  }

  void append(size_t begin, size_t end, FileWindows& windows, StrandArrays& a) const override {
    const size_t before = a.first_point.back(), per_strand = header_.points_per_strand;
    append_places(*this, begin, end, a);
    const size_t count = (end - begin) * per_strand;
    const uint64_t from = begin * per_strand;
    a.points.resize((before + count) * 4);
    const std::span<float> points = std::span(a.points).subspan(before * 4);
    windows.read(header_.points + from * 16, points);
    size_t next = 0;
    if (!a.attributes.empty() && a.attributes[0].name == kMovable) {
      std::vector<float>& movable = a.attributes[next++].values;
      for (size_t p = 0; p < count; ++p) movable.push_back(points[4 * p + 3]);
    }
    if (header_.strand_uv) {
      const std::vector<float> uv = floats(windows, header_.strand_uv + begin * 8, (end - begin) * 2);
      for (size_t s = 0; s < uv.size(); s += 2) a.root_uv.emplace_back(uv[s], uv[s + 1]);
    }
    if (header_.thickness) {
      const std::vector<float> thickness = floats(windows, header_.thickness + begin * 4, end - begin);
      for (size_t p = 0; p < count; ++p) points[4 * p + 3] = 0.5f * thickness[p / per_strand];
    }
    if (header_.point_uv) append_values(windows, header_.point_uv + from * 8, count, a.attributes[next++]);
    if (header_.color) append_color(windows, from, count, a.attributes[next], a.attributes[next + 1]);
  }

 private:
  static std::vector<float> floats(FileWindows& windows, uint64_t offset, size_t count) {
    std::vector<float> values(count);
    windows.read(offset, std::span(values));
    return values;
  }

  /// Splits RGBA, a few thousand points at a time.
  void append_color(FileWindows& windows, uint64_t from, size_t count, StrandAttribute& color,
                    StrandAttribute& opacity) const {
    constexpr size_t kPart = 4096;
    const size_t before = opacity.values.size();
    color.values.resize((before + count) * 3);
    opacity.values.resize(before + count);
    std::vector<float> rgba;
    for (size_t i = 0; i < count; i += kPart) {
      rgba.resize(std::min(kPart, count - i) * 4);
      windows.read(header_.color + (from + i) * 16, std::span(rgba));
      for (size_t k = 0; k < rgba.size() / 4; ++k) {
        std::copy_n(&rgba[k * 4], 3, &color.values[(before + i + k) * 3]);
        opacity.values[before + i + k] = rgba[k * 4 + 3];
      }
    }
  }

  const TfxHeader header_;
};

}  // namespace

std::unique_ptr<RawStrands> open_tfx(const std::filesystem::path& path, const StrandReadOptions& options) {
  return std::make_unique<TfxFile>(path, options);
}

void write_tfx(const std::filesystem::path& path, const Strands& strands, bool widths) {
  if (strands.strand_count() == 0) fail_to_write(path, "there are no strands to write");
  const uint32_t per_strand = strands.strand_points(0);
  for (size_t s = 1; s < strands.strand_count(); ++s) {
    if (strands.strand_points(s) == per_strand) continue;
    fail_to_write(path, "the .tfx format needs the same number of points in every strand; strand 0 has " +
                            std::to_string(per_strand) + ", strand " + std::to_string(s) + " has " +
                            std::to_string(strands.strand_points(s)));
  }
  const StrandAttribute* color = strands.find_attribute("color");
  const StrandAttribute* opacity = strands.find_attribute("opacity");
  const StrandAttribute* transparency = opacity ? nullptr : strands.find_attribute("transparency");
  const StrandAttribute* movable = strands.find_attribute(kMovable);
  const StrandAttribute* uv = strands.find_attribute("uv");
  const bool has_root_uv = !strands.arrays().root_uv.empty();

  TfxHeader header{};
  header.version = 4.0f;
  header.strand_count = static_cast<uint32_t>(strands.strand_count());
  header.points_per_strand = per_strand;
  uint64_t end = sizeof header;
  const auto place = [&](uint64_t count, uint64_t components) {
    const uint64_t begin = end;
    end += (count * components * sizeof(float) + 7) / 8 * 8;  // arrays begin at multiples of 8 bytes
    return static_cast<uint32_t>(begin);
  };
  const size_t points = strands.point_count();
  header.points = place(points, 4);
  if (has_root_uv) header.strand_uv = place(strands.strand_count(), 2);
  if (uv) header.point_uv = place(points, 2);
  const bool has_color = color || opacity || transparency;
  if (has_color) header.color = place(points, 4);
  if (widths) header.thickness = place(strands.strand_count(), 1);
  if (end > std::numeric_limits<uint32_t>::max()) fail_to_write(path, "the .tfx format holds at most 4 GiB");

  AtomicFile file(path);
  file.write(std::as_bytes(std::span(&header, 1)));
  write_per_point(file, strands, 4, [&](size_t strand, size_t point, float* out) {
    const V3f p = strands.point(point);
    std::copy_n(&p.x, 3, out);
    out[3] = usually_movable(strands, strand, point);
    if (movable) attribute_at(*movable, strand, point, 1, out + 3);
  });
  if (has_root_uv) {
    std::vector<float> values;
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      values.push_back(strands.root_uv(s).x);
      values.push_back(strands.root_uv(s).y);
    }
    file.write(std::as_bytes(std::span(values)));
  }
  if (uv) {
    write_per_point(file, strands, 2, [&](size_t strand, size_t point, float* out) {
      attribute_at(*uv, strand, point, 2, out);
    });
  }
  if (has_color) {
    write_per_point(file, strands, 4, [&](size_t strand, size_t point, float* out) {
      std::fill_n(out, 4, 1.0f);
      if (color) attribute_at(*color, strand, point, 3, out);
      if (opacity) attribute_at(*opacity, strand, point, 1, out + 3);
      if (transparency) attribute_at(*transparency, strand, point, 1, out + 3);
      if (transparency) out[3] = 1 - out[3];
    });
  }
  if (!widths) return file.commit();
  std::vector<float> thickness;
  for (size_t s = 0; s < strands.strand_count(); ++s) thickness.push_back(2 * largest_radius(strands, s));
  file.write(std::as_bytes(std::span(thickness)));
  file.commit();
}

}  // namespace pelage
