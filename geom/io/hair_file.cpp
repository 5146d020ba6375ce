// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <limits>
#include <type_traits>

#include "base/file.h"
#include "geom/io/strand_formats.h"

// Cem Yuksel's .hair format [CyHair]: a header of 128 bytes, then the arrays flagged in the bits of `arrays`:
// segments per strand (uint16), points (3 floats), thickness (float, a diameter), transparency (float) and
// colour (3 floats), the last four per point.

namespace pelage {
namespace {

struct Header {
  char signature[4];
  uint32_t strand_count;
  uint32_t point_count;
  uint32_t arrays;
  uint32_t default_segments;
  float default_thickness;
  float default_transparency;
  float default_color[3];
  char information[88];
};
static_assert(sizeof(Header) == 128 && std::is_trivially_copyable_v<Header>);

enum Array : uint32_t { kSegments = 1, kPoints = 2, kThickness = 4, kTransparency = 8, kColor = 16 };
constexpr uint32_t kAllArrays = 31;

/// Offset of each array; all are validated to lie within the file.
struct Layout {
  uint64_t segments = 0, points = 0, thickness = 0, transparency = 0, color = 0;
};

Header read_header(const BinaryFile& file) {
  Header header;
  file.require(0, sizeof header, 1, "bytes of header");
  file.read_bytes(0, &header, sizeof header);
  if (std::memcmp(header.signature, "HAIR", 4) != 0)
    file.fail("is not a .hair file: it does not begin with HAIR");
  if (header.arrays & ~uint32_t(kAllArrays)) file.fail("claims arrays that the .hair format does not define");
  if (!(header.arrays & kPoints)) file.fail("holds no points");
  if (header.strand_count == 0) file.fail("holds no strands");
  return header;
}

Layout check_layout(const BinaryFile& file, const Header& header) {
  uint64_t end = sizeof(Header);
  const auto place = [&](Array array, uint64_t count, uint64_t size, const char* what) -> uint64_t {
    if (!(header.arrays & array)) return 0;
    file.require(end, count, size, what);
    const uint64_t begin = end;
    end += count * size;
    return begin;
  };
  Layout layout;
  layout.segments = place(kSegments, header.strand_count, 2, "segment counts");
  layout.points = place(kPoints, header.point_count, 12, "points");
  layout.thickness = place(kThickness, header.point_count, 4, "thicknesses");
  layout.transparency = place(kTransparency, header.point_count, 4, "transparencies");
  layout.color = place(kColor, header.point_count, 12, "colours");
  return layout;
}

/// Empty where all strands have the number of segments in the header.
std::vector<uint32_t> read_first_points(const BinaryFile& file, const Header& header, const Layout& layout) {
  const uint64_t strands = header.strand_count;
  const auto check_total = [&](uint64_t points) {
    if (points == header.point_count) return;
    file.fail("its " + std::to_string(strands) + " strands need " + std::to_string(points) +
              " points, but it claims " + std::to_string(header.point_count));
  };
  std::vector<uint32_t> first;
  if (!layout.segments) {
    // Strands that only the header declares: each of them must have a point.
    check_total(strands * (uint64_t(header.default_segments) + 1));
    return first;
  }
  std::vector<uint16_t> segments(strands);
  file.read(layout.segments, segments);
  first.resize(strands + 1);
  uint64_t total = 0;
  for (size_t s = 0; s < strands; ++s) {
    first[s] = static_cast<uint32_t>(total);
    total += uint64_t(segments[s]) + 1;
  }
  check_total(total);
  first[strands] = header.point_count;
  return first;
}

/// Number of segments per strand if all have the same number, else -1.
int64_t common_segments(const Strands& strands) {
  for (size_t s = 1; s < strands.strand_count(); ++s) {
    if (strands.strand_points(s) != strands.strand_points(0)) return -1;
  }
  return int64_t(strands.strand_points(0)) - 1;
}

}  // namespace

namespace {

class HairFile final : public RawStrands {
 public:
  HairFile(const std::filesystem::path& path, const StrandReadOptions& options)
      : RawStrands(path, "hair", options),
        header_(read_header(file)),
        layout_(check_layout(file, header_)),
        first_(read_first_points(file, header_, layout_)) {
    strand_count = header_.strand_count;
    has_widths = layout_.thickness != 0;
    file_width = header_.default_thickness;
    if (layout_.transparency) {
      attributes.push_back({"transparency", AttributeClass::kPerPoint, 1, {}});
    } else if (header_.default_transparency != 0) {
      attributes.push_back({"transparency", AttributeClass::kConstant, 1, {header_.default_transparency}});
    }
    const float* color = header_.default_color;
    if (layout_.color) {
      attributes.push_back({"color", AttributeClass::kPerPoint, 3, {}});
    } else if (color[0] != 0 || color[1] != 0 || color[2] != 0) {
      attributes.push_back({"color", AttributeClass::kConstant, 3, {color[0], color[1], color[2]}});
    }
  }

  uint32_t first_point(size_t strand) const override {
    return first_.empty() ? static_cast<uint32_t>(strand * (size_t(header_.default_segments) + 1))
                          : first_[strand];
  }

  void append(size_t begin, size_t end, FileWindows& windows, StrandArrays& a) const override {
    const size_t before = a.first_point.back();
    append_places(*this, begin, end, a);
    const uint64_t from = first_point(begin);
    const size_t count = a.first_point.back() - before;
    a.points.resize((before + count) * 4);
    float* points = a.points.data() + before * 4;
    read_point_parts(windows, layout_.points + from * 12, 3, count, points);
    if (layout_.thickness) {
      read_point_parts(windows, layout_.thickness + from * 4, 1, count, points + 3);
      for (size_t i = 3; i < count * 4; i += 4) points[i] *= 0.5f;
    }
    for (StrandAttribute& attribute : a.attributes) {
      if (attribute.frequency == AttributeClass::kConstant) continue;
      const bool is_color = attribute.name == "color";
      append_values(windows, is_color ? layout_.color + from * 12 : layout_.transparency + from * 4, count,
                    attribute);
    }
  }

  size_t bytes() const override { return first_.capacity() * sizeof(uint32_t); }

 private:
  Header header_;
  Layout layout_;
  std::vector<uint32_t> first_;
};

}  // namespace

std::unique_ptr<RawStrands> open_hair(const std::filesystem::path& path, const StrandReadOptions& options) {
  return std::make_unique<HairFile>(path, options);
}

void write_hair(const std::filesystem::path& path, const Strands& strands, bool widths) {
  if (strands.strand_count() == 0) fail_to_write(path, "there are no strands to write");
  constexpr uint32_t kMaxSegments = std::numeric_limits<uint16_t>::max();
  const int64_t common = common_segments(strands);
  for (size_t s = 0; common < 0 && s < strands.strand_count(); ++s) {
    if (strands.strand_points(s) - 1 > kMaxSegments) {
      fail_to_write(path, "the .hair format holds at most 65536 points per strand, strand " +
                              std::to_string(s) + " has " + std::to_string(strands.strand_points(s)));
    }
  }
  const StrandAttribute* color = strands.find_attribute("color");
  const StrandAttribute* transparency = strands.find_attribute("transparency");
  const StrandAttribute* opacity = transparency ? nullptr : strands.find_attribute("opacity");

  Header header{};
  std::memcpy(header.signature, "HAIR", 4);
  std::strcpy(header.information, "Written by Pelage");
  header.strand_count = static_cast<uint32_t>(strands.strand_count());
  header.point_count = static_cast<uint32_t>(strands.point_count());
  header.arrays = kPoints | (widths ? kThickness : 0u);
  if (common < 0) header.arrays |= kSegments;
  if (common >= 0) header.default_segments = static_cast<uint32_t>(common);
  if (transparency && transparency->frequency == AttributeClass::kConstant) {
    header.default_transparency = transparency->values[0];
  } else if (transparency || opacity) {
    header.arrays |= kTransparency;
  }
  if (color && color->frequency == AttributeClass::kConstant) {
    attribute_at(*color, 0, 0, 3, header.default_color);
  } else if (color) {
    header.arrays |= kColor;
  }

  AtomicFile file(path);
  file.write(std::as_bytes(std::span(&header, 1)));
  if (common < 0) {
    std::vector<uint16_t> segments;
    segments.reserve(strands.strand_count());
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      segments.push_back(static_cast<uint16_t>(strands.strand_points(s) - 1));
    }
    file.write(std::as_bytes(std::span(segments)));
  }
  write_per_point(file, strands, 3, [&](size_t, size_t point, float* out) {
    const V3f p = strands.point(point);
    std::copy_n(&p.x, 3, out);
  });
  if (widths) {
    write_per_point(file, strands, 1,
                    [&](size_t, size_t point, float* out) { *out = 2 * strands.radius(point); });
  }
  if (header.arrays & kTransparency) {
    write_per_point(file, strands, 1, [&](size_t strand, size_t point, float* out) {
      attribute_at(transparency ? *transparency : *opacity, strand, point, 1, out);
      if (opacity) *out = 1 - *out;
    });
  }
  if (header.arrays & kColor) {
    write_per_point(file, strands, 3, [&](size_t strand, size_t point, float* out) {
      attribute_at(*color, strand, point, 3, out);
    });
  }
  file.commit();
}

}  // namespace pelage
