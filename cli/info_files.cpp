// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <map>
#include <variant>

#include <fmt/format.h>

#include "base/value_readers.h"
#include "cli/info.h"
#include "groom/strands/curve_basis_names.h"
#include "starter/body_shape.h"

namespace pelage {
namespace {

// Max length of an attribute text shown completely.
constexpr size_t kLongestText = 100;

template <class T>
std::string shown(const T& value) {
  return ValueReader<T>::print(value);
}

std::string shown_box(const Box3f& box) {
  return box.isEmpty() ? "empty" : fmt::format("{} to {}", shown(box.min), shown(box.max));
}

// "name: value" without control characters, which would affect the terminal.
std::string printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  if (text.size() > kLongestText) text = text.substr(0, kLongestText) + "...";
  return text;
}

std::string describe(const ExrAttribute& attribute) {
  struct Printer {
    std::string operator()(int v) const { return std::to_string(v); }
    std::string operator()(float v) const { return shown(v); }
    std::string operator()(const std::string& v) const { return printable(v); }
    std::string operator()(const V2f& v) const { return shown(v); }
    std::string operator()(const V3f& v) const { return shown(v); }
    std::string operator()(const M44f& v) const {
      std::string rows;
      for (const auto& row : v.x) {
        rows += fmt::format("{}[{}, {}, {}, {}]", rows.empty() ? "" : " ", row[0], row[1], row[2], row[3]);
      }
      return rows;
    }
  };
  return std::visit(Printer{}, attribute);
}

const char* type_name(ChannelType type) {
  switch (type) {
    case ChannelType::kHalf:
      return "half";
    case ChannelType::kFloat:
      return "float";
    case ChannelType::kUint:
      return "uint";
  }
  return "";
}

}  // namespace

std::string describe_strands(const StrandFile& file) {
  const Strands& strands = file.strands;
  Box3f box;
  float thinnest = std::numeric_limits<float>::infinity(), thickest = 0;
  for (size_t i = 0; i < strands.point_count(); ++i) {
    box.extendBy(strands.point(i));
    thinnest = std::min(thinnest, 2 * strands.radius(i));
    thickest = std::max(thickest, 2 * strands.radius(i));
  }
  uint32_t fewest = std::numeric_limits<uint32_t>::max(), max = 0;
  for (size_t i = 0; i < strands.strand_count(); ++i) {
    fewest = std::min(fewest, strands.strand_points(i));
    max = std::max(max, strands.strand_points(i));
  }
  std::string text = fmt::format("strands ({}), {} strands, {} points, basis {}\n", file.format,
                                 strands.strand_count(), strands.point_count(), shown(strands.basis()));
  if (strands.strand_count() > 0) {
    text += fmt::format("  points per strand: {} to {}\n", fewest, max);
    text += fmt::format("  widths: {} to {}\n", shown(thinnest), shown(thickest));
    text += fmt::format("  bounds of the control points: {}\n", shown_box(box));
  }
  for (const StrandAttribute& attribute : strands.attributes()) {
    text += fmt::format("  attribute {}: {} x {} numbers\n", printable(attribute.name),
                        attribute.values.size() / static_cast<size_t>(std::max(attribute.components, 1)),
                        attribute.components);
  }
  return text + fmt::format("  repaired: {}, dropped: {}\n", file.repairs.repaired, file.repairs.dropped);
}

namespace {

/// What `pelage new` would make of a mesh.
std::string describe_body(const ControlMesh& mesh, const std::string& source) try {
  const BodyShape shape = body_shape(mesh, source);
  const V3f size = shape.box.size();
  const int longest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return fmt::format(
      "  size: {:.4g} x {:.4g} x {:.4g}, longest along {}\n"
      "  suggested: facing {}, up {}, scheme {}, meters_per_unit {:g}\n"
      "  doubled faces: {}\n"
      "  texture coordinates: {}\n",
      size.x, size.y, size.z, "xyz"[longest], shape.facing.name(), shape.up.name(), shown(shape.scheme),
      shape.meters_per_unit, shape.doubled_faces, mesh.face_uv.empty() ? "no" : "yes");
} catch (const Error& error) {
  return fmt::format("  not a body: {}\n", error.what());
}

}  // namespace

std::string describe_mesh(const ControlMesh& mesh, const std::string& source) {
  Box3f box;
  for (const V3f& position : mesh.positions) box.extendBy(position);
  std::string text = fmt::format("mesh, {} faces, {} vertices, {} texture coordinates\n", mesh.face_count(),
                                 mesh.positions.size(), mesh.uv.size());
  std::map<uint32_t, size_t> sizes;
  for (const uint32_t size : mesh.face_sizes) ++sizes[size];
  for (const auto& [size, count] : sizes) text += fmt::format("  {} faces with {} corners\n", count, size);
  text += fmt::format("  bounds: {}\n", shown_box(box));
  text += describe_body(mesh, source);
  text += fmt::format("  creases: {}, corners: {}, holes: {}\n", mesh.creases.size(), mesh.corners.size(),
                      mesh.holes.size());
  for (const std::string& group : mesh.groups) text += fmt::format("  group {}\n", printable(group));
  return text;
}

std::string describe_exr(const ExrImage& image) {
  std::string text =
      fmt::format("image, {} x {} pixels, {} channels\n", image.width, image.height, image.channels.size());
  // Groups channels by layer: "key.diffuse: R G B (half)".
  std::map<std::string, std::map<ChannelType, std::string>> layers;
  for (const ExrChannel& channel : image.channels) {
    const size_t dot = channel.name.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : channel.name.substr(0, dot);
    layers[layer][channel.type] += " " + channel.name.substr(dot == std::string::npos ? 0 : dot + 1);
  }
  for (const auto& [layer, types] : layers) {
    text += "  " + (layer.empty() ? "no layer" : "layer " + printable(layer)) + ":";
    for (const auto& [type, names] : types) text += fmt::format("{} ({})", printable(names), type_name(type));
    text += "\n";
  }
  for (const auto& [name, value] : image.attributes) {
    text += fmt::format("  attribute {}: {}\n", printable(name), describe(value));
  }
  return text;
}

}  // namespace pelage
