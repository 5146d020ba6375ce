// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>

#include "base/file.h"
#include "geom/io/strand_formats.h"

// Cem Yuksel's .hair format [CyHair]: a header of 128 bytes, then, as far as the bits of `arrays` say so,
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

/// Where each array begins; every one has been found to lie within the file.
struct Layout {
  uint64_t segments = 0, points = 0, thickness = 0, transparency = 0, color = 0;
};

Header read_header(BinaryFile& file) {
  Header header;
  file.require(0, sizeof header, 1, "bytes of header");
  file.read_bytes(0, &header, sizeof header);
  if (std::memcmp(header.signature, "HAIR", 4) != 0)
    file.fail("is not a .hair file: it does not begin with HAIR");
  if (header.arrays & ~uint32_t(kAllArrays)) file.fail("claims arrays that the .hair format does not have");
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

std::vector<uint32_t> read_first_points(BinaryFile& file, const Header& header, const Layout& layout) {
  const uint64_t strands = header.strand_count;
  const auto check_total = [&](uint64_t points) {
    if (points == header.point_count) return;
    file.fail("its " + std::to_string(strands) + " strands need " + std::to_string(points) +
              " points, but it claims " + std::to_string(header.point_count));
  };
  std::vector<uint32_t> first;
  if (!layout.segments) {
    // Before anything is allocated for strands that only the header knows of: each of them has a point.
    check_total(strands * (uint64_t(header.default_segments) + 1));
    first.resize(strands + 1);
    for (size_t s = 0; s <= strands; ++s) first[s] = static_cast<uint32_t>(s) * (header.default_segments + 1);
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

StrandAttribute read_attribute(BinaryFile& file, const char* name, int components, uint64_t offset,
                               size_t points) {
  StrandAttribute attribute{name, AttributeClass::kPerPoint, components, {}};
  attribute.values.resize(points * static_cast<size_t>(components));
  file.read(offset, std::span(attribute.values));
  return attribute;
}

/// Segments of every strand when all have equally many, else -1.
int64_t common_segments(const Strands& strands) {
  for (size_t s = 1; s < strands.strand_count(); ++s) {
    if (strands.strand_points(s) != strands.strand_points(0)) return -1;
  }
  return int64_t(strands.strand_points(0)) - 1;
}

}  // namespace

StrandFile read_hair(const std::filesystem::path& path, const StrandReadOptions& options) {
  BinaryFile file(path);
  const Header header = read_header(file);
  const Layout layout = check_layout(file, header);
  StrandArrays a;
  a.basis = options.basis.value_or(CurveBasis::kPinnedBSpline);
  a.first_point = read_first_points(file, header, layout);
  a.ids.resize(header.strand_count);
  std::iota(a.ids.begin(), a.ids.end(), uint64_t(0));
  const size_t points = header.point_count;
  a.points.resize(points * 4);
  read_point_parts(file, layout.points, 3, points, a.points.data());
  if (layout.thickness) {
    read_point_parts(file, layout.thickness, 1, points, a.points.data() + 3);
    for (size_t i = 3; i < a.points.size(); i += 4) a.points[i] *= 0.5f;
  }
  if (layout.transparency) {
    a.attributes.push_back(read_attribute(file, "transparency", 1, layout.transparency, points));
  } else if (header.default_transparency != 0) {
    a.attributes.push_back({"transparency", AttributeClass::kConstant, 1, {header.default_transparency}});
  }
  const float* color = header.default_color;
  if (layout.color) {
    a.attributes.push_back(read_attribute(file, "color", 3, layout.color, points));
  } else if (color[0] != 0 || color[1] != 0 || color[2] != 0) {
    a.attributes.push_back({"color", AttributeClass::kConstant, 3, {color[0], color[1], color[2]}});
  }
  const bool has_widths = layout.thickness != 0;
  return finish_strands(std::move(a), "hair", options, has_widths, header.default_thickness);
}

void write_hair(const std::filesystem::path& path, const Strands& strands) {
  if (strands.strand_count() == 0) fail_to_write(path, "there are no strands to write");
  constexpr uint32_t kMostSegments = std::numeric_limits<uint16_t>::max();
  const int64_t common = common_segments(strands);
  for (size_t s = 0; common < 0 && s < strands.strand_count(); ++s) {
    if (strands.strand_points(s) - 1 > kMostSegments) {
      fail_to_write(path, "the .hair format holds at most 65536 points a strand, strand " +
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
  header.arrays = kPoints | kThickness;
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
  write_per_point(file, strands, 1,
                  [&](size_t, size_t point, float* out) { *out = 2 * strands.radius(point); });
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
