// SPDX-License-Identifier: Apache-2.0
#include "image/exr_header.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

namespace pelage {
namespace {

/// Attributes that define the shape of the image: set by the writer, not included in `attributes`.
constexpr std::array kStructure = {"channels",   "compression",   "dataWindow", "displayWindow",
                                   "lineOrder",  "tiles",         "type",       "version",
                                   "chunkCount", "chromaticities"};

struct AttributeWriter {
  Imf::Header& header;
  const char* name;
  void operator()(int v) const { header.insert(name, Imf::IntAttribute(v)); }
  void operator()(float v) const {
    if (std::string_view(name) == "framesPerSecond") {  // a standard attribute with its own type
      header.insert(name, Imf::RationalAttribute(Imf::Rational(static_cast<double>(v))));
    } else {
      header.insert(name, Imf::FloatAttribute(v));
    }
  }
  void operator()(const std::string& v) const { header.insert(name, Imf::StringAttribute(v)); }
  void operator()(const V2f& v) const { header.insert(name, Imf::V2fAttribute(v)); }
  void operator()(const V3f& v) const { header.insert(name, Imf::V3fAttribute(v)); }
  void operator()(const M44f& v) const { header.insert(name, Imf::M44fAttribute(v)); }
};

template <class Attribute>
bool read_attribute(const Imf::Header& header, const std::string& name, ExrAttributes& attributes) {
  const auto* attribute = header.findTypedAttribute<Attribute>(name);
  if (attribute) attributes[name] = attribute->value();
  return attribute != nullptr;
}

bool read_rational(const Imf::Header& header, const std::string& name, ExrAttributes& attributes) {
  const auto* attribute = header.findTypedAttribute<Imf::RationalAttribute>(name);
  if (attribute) attributes[name] = static_cast<float>(static_cast<double>(attribute->value()));
  return attribute != nullptr;
}

}  // namespace

Imf::PixelType pixel_type(ChannelType type) {
  switch (type) {
    case ChannelType::kHalf:
      return Imf::HALF;
    case ChannelType::kFloat:
      return Imf::FLOAT;
    case ChannelType::kUint:
      return Imf::UINT;
  }
  return Imf::HALF;
}

ChannelType channel_type(Imf::PixelType type) {
  if (type == Imf::UINT) return ChannelType::kUint;
  return type == Imf::FLOAT ? ChannelType::kFloat : ChannelType::kHalf;
}

ExrAttributes read_attributes(const Imf::Header& header) {
  ExrAttributes found;
  for (auto a = header.begin(); a != header.end(); ++a) {
    const std::string name = a.name();
    if (std::find(kStructure.begin(), kStructure.end(), name) != kStructure.end()) continue;
    read_attribute<Imf::IntAttribute>(header, name, found) ||
        read_attribute<Imf::FloatAttribute>(header, name, found) ||
        read_attribute<Imf::StringAttribute>(header, name, found) ||
        read_attribute<Imf::V2fAttribute>(header, name, found) ||
        read_attribute<Imf::V3fAttribute>(header, name, found) ||
        read_attribute<Imf::M44fAttribute>(header, name, found) || read_rational(header, name, found);
  }
  return found;
}

void insert_attributes(Imf::Header& header, const ExrAttributes& attributes) {
  for (const auto& [name, value] : attributes) std::visit(AttributeWriter{header, name.c_str()}, value);
}

}  // namespace pelage
