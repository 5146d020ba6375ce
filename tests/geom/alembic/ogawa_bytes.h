// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

// Files of Alembic made by hand: what AlembicWriter does not write, and what no program should write. The
// layout is written down here a second time, on purpose.

namespace pelage::ogawa_bytes {

template <class T>
std::string raw(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}
template <class T>
std::string raw(std::initializer_list<T> values) {
  return raw(std::vector<T>(values));
}

constexpr uint64_t kDataBit = uint64_t(1) << 63;

/// Types of numbers, as files number them.
enum Pod : uint32_t {
  kInt8 = 2,
  kUint8 = 1,
  kInt16 = 4,
  kUint32 = 5,
  kInt32 = 6,
  kFloat = 10,
  kDouble = 11,
  kText = 12
};

/// A property or an object: its header, and its word in the group of its parent.
struct Part {
  std::string header;
  uint64_t word = 0;
};

class OgawaBytes {
 public:
  OgawaBytes() : bytes_("Ogawa\xff\0\x01\0\0\0\0\0\0\0\0", 16) {}

  uint64_t data(std::string_view bytes) {
    if (bytes.empty()) return kDataBit;
    const uint64_t position = bytes_.size();
    bytes_ += raw<uint64_t>({bytes.size()});
    bytes_ += bytes;
    return position | kDataBit;
  }
  uint64_t group(const std::vector<uint64_t>& words) {
    if (words.empty()) return 0;
    const uint64_t position = bytes_.size();
    bytes_ += raw<uint64_t>({words.size()}) + raw(words);
    return position;
  }

  /// Properties with the samples `values`, of which each has the key "0123456789abcdef".
  Part scalar(const std::string& name, Pod pod, uint32_t extent, const std::vector<std::string>& values,
              const std::string& metadata = "") {
    return property(1, name, pod, extent, values, metadata);
  }
  Part array(const std::string& name, Pod pod, uint32_t extent, const std::vector<std::string>& values,
             const std::string& metadata = "") {
    return property(2, name, pod, extent, values, metadata);
  }
  Part compound(const std::string& name, const std::vector<Part>& parts, const std::string& metadata = "") {
    return {raw<uint32_t>({0x0ff00000}) + short_text(name) + short_text(metadata), compound_group(parts)};
  }
  uint64_t compound_group(const std::vector<Part>& parts) {
    std::vector<uint64_t> words;
    std::string headers;
    for (const Part& part : parts) {
      words.push_back(part.word);
      headers += part.header;
    }
    if (!words.empty()) words.push_back(data(headers));
    return group(words);
  }

  Part object(const std::string& name, const std::string& schema, const std::vector<Part>& properties,
              const std::vector<Part>& children = {}) {
    const std::string metadata = schema.empty() ? "" : "schema=" + schema;
    const auto text = [](const std::string& t) {
      return raw<uint32_t>({static_cast<uint32_t>(t.size())}) + t;
    };
    return {text(name) + "\xff" + text(metadata), object_group(properties, children)};
  }
  uint64_t object_group(const std::vector<Part>& properties, const std::vector<Part>& children) {
    std::vector<uint64_t> words{compound_group(properties)};
    std::string headers;
    for (const Part& child : children) {
      words.push_back(child.word);
      headers += child.header;
    }
    words.push_back(data(headers + std::string(32, 'h')));
    return group(words);
  }

  /// The whole file. `top`: the group of the top object; else it has the objects `children`.
  std::string file(const std::vector<Part>& children) { return file(object_group({}, children)); }
  std::string file(uint64_t top) {
    const uint64_t root = group(
        {data(raw<int32_t>({0})), data(raw<int32_t>({10700})), top, data("a=b"),
         data(raw<uint32_t>({1}) + raw<double>({1}) + raw<uint32_t>({1}) + raw<double>({0})), data("")});
    std::string bytes = bytes_;
    return bytes.replace(8, 8, raw<uint64_t>({root}));
  }
  uint64_t size() const { return bytes_.size(); }
  /// Replaces the word at a position.
  void set(uint64_t position, uint64_t word) { bytes_.replace(position, 8, raw<uint64_t>({word})); }

  /// Curves: a zigzag of points (0, 0, 0), (1, 1, 0), (2, 0, 0) and so on, in curves of `counts` points.
  Part curves(const std::string& name, const std::vector<int32_t>& counts, const std::string& form,
              const std::vector<Part>& geometry = {}, const std::vector<Part>& params = {}) {
    std::vector<float> points;
    for (const int32_t count : counts) {
      for (int32_t i = 0; i < count; ++i)
        points.insert(points.end(), {static_cast<float>(i), static_cast<float>(i % 2), 0});
    }
    std::vector<Part> parts{array("P", kFloat, 3, {raw(points)}, "geoScope=vtx"),
                            array("nVertices", kInt32, 1, {raw(counts)}),
                            scalar("curveBasisAndType", kUint8, 4, {form})};
    parts.insert(parts.end(), geometry.begin(), geometry.end());
    if (!params.empty()) parts.push_back(compound(".arbGeomParams", params));
    return object(name, "AbcGeom_Curve_v2", {compound(".geom", parts)});
  }

 private:
  static std::string short_text(const std::string& text) {
    return std::string(1, static_cast<char>(text.size())) + text;
  }
  Part property(uint32_t kind, const std::string& name, Pod pod, uint32_t extent,
                const std::vector<std::string>& values, const std::string& metadata) {
    std::vector<uint64_t> words;
    for (const std::string& value : values) {
      words.push_back(data(value.empty() ? "" : "0123456789abcdef" + value));
      if (kind == 2) words.push_back(kDataBit);  // sizes follow from the data
    }
    const uint32_t constant = values.size() == 1 ? 0x800 : 0;
    return {raw<uint32_t>({0x0ff00000 | kind | pod << 4 | extent << 12 | constant}) +
                std::string(1, static_cast<char>(values.size())) + short_text(name) + short_text(metadata),
            group(words)};
  }

  std::string bytes_;
};

/// Values of curveBasisAndType.
inline std::string curve_form(int type, int wrap, int basis) {
  return {static_cast<char>(type), static_cast<char>(wrap), static_cast<char>(basis),
          static_cast<char>(basis)};
}
inline std::string linear_form() { return curve_form(1, 0, 0); }

}  // namespace pelage::ogawa_bytes
