// SPDX-License-Identifier: Apache-2.0
#include "geom/io/obj_file.h"

#include <algorithm>
#include <limits>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include "base/file.h"
#include "base/job.h"
#include "geom/io/obj_scanner.h"

namespace pelage {

namespace {

// Keeps the number of corners within 32 bits: the shortest corner takes two bytes.
constexpr size_t kLongestFile = size_t(2) << 30;
constexpr uint32_t kNoUv = std::numeric_limits<uint32_t>::max();
constexpr int64_t kMaxIndex = std::numeric_limits<int32_t>::max();

/// Further numbers, a weight or a colour, are not read.
V3f read_position(ObjScanner& scanner) {
  V3f p(0);
  if (scanner.number("x, a number", p.x) && scanner.number("y, a number", p.y))
    scanner.number("z, a number", p.z);
  return p;
}

/// The vertices of a face, counted from 0. Numbers below 1 count back from the last of `count` vertices.
void read_face_vertices(ObjScanner& scanner, size_t count, std::vector<uint32_t>& face) {
  face.clear();
  for (std::string_view token; scanner.next_token(token);) {
    int64_t index = 0;
    if (!scanner.parse_integer(token.substr(0, token.find('/')), "the number of a vertex", index)) return;
    face.push_back(static_cast<uint32_t>(index < 0 ? static_cast<int64_t>(count) + index : index - 1));
  }
}

/// Reads one file. References to later elements are checked at the end.
class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& file, const Job* job)
      : scanner_(text, file), job_(job) {}

  ControlMesh read();

 private:
  struct Reference {
    uint32_t index;
    int line;
  };

  void read_vertex();
  void read_uv();
  void read_face();
  bool read_corner(std::string_view token);
  bool resolve(int64_t index, size_t count, const char* what, uint32_t& result);
  void check_face(size_t first);
  void read_group(std::string name);
  void read_name(const std::string& name, ControlMesh::FaceNames& all, int& current);
  void read_tag();
  std::vector<int64_t> read_tag_integers(int64_t count);
  std::vector<float> read_tag_sharpness(int64_t count, size_t wanted);
  void check_references();
  void complete_uv();

  ObjScanner scanner_;
  const Job* job_;  // null: cannot be stopped
  ControlMesh mesh_;
  std::vector<int> face_lines_;
  std::vector<Reference> vertex_references_;  // of tags
  std::vector<Reference> face_references_;
  std::unordered_map<std::string, uint16_t> group_numbers_;
  std::map<const ControlMesh::FaceNames*, std::unordered_map<std::string, int>> name_numbers_;
  int current_group_ = -1, current_object_ = -1, current_material_ = -1;
};

ControlMesh ObjReader::read() {
  std::string_view keyword;
  for (size_t statement = 0; scanner_.next_statement(keyword); ++statement) {
    if (job_ && statement % 4096 == 0) job_->check_stop();
    if (keyword == "v") {
      read_vertex();
    } else if (keyword == "vt") {
      read_uv();
    } else if (keyword == "f") {
      read_face();
    } else if (keyword == "g" || keyword == "o") {
      const std::string name(scanner_.rest());
      if (keyword == "o") read_name(name, mesh_.objects, current_object_);
      read_group(name);
    } else if (keyword == "usemtl") {
      read_name(std::string(scanner_.rest()), mesh_.materials, current_material_);
    } else if (keyword == "t") {
      read_tag();
    }
  }
  check_references();
  if (mesh_.face_sizes.empty()) scanner_.report_line(0, "has no faces");
  scanner_.throw_if_any();
  complete_uv();
  return std::move(mesh_);
}

void ObjReader::read_vertex() {
  mesh_.positions.push_back(read_position(scanner_));
  std::string_view token[3];
  int count = 0;
  while (count < 3 && scanner_.next_token(token[count])) ++count;
  Rgb color(1);
  if (count == 3) {
    for (int c = 0; c < 3; ++c) {
      if (!scanner_.parse_number(token[c], "a channel of the vertex colour, a number", color[c])) return;
    }
    mesh_.colors.resize(mesh_.positions.size() - 1, Rgb(1));
  }
  if (count == 3 || !mesh_.colors.empty()) mesh_.colors.push_back(color);
}

void ObjReader::read_uv() {
  V2f uv(0);
  if (scanner_.number("u, a number", uv.x)) {
    std::string_view token;
    if (scanner_.next_token(token)) scanner_.parse_number(token, "v, a number", uv.y);
  }
  mesh_.uv.push_back(uv);
}

bool ObjReader::resolve(int64_t index, size_t count, const char* what, uint32_t& result) {
  if (index == 0) {
    scanner_.report(fmt::format("{} 0: indices count from 1", what));
    return false;
  }
  if (index < -static_cast<int64_t>(count) || index > kMaxIndex) {
    scanner_.report(fmt::format("{} {} does not exist: only {} precede it", what, index, count));
    return false;
  }
  result = static_cast<uint32_t>(index < 0 ? static_cast<int64_t>(count) + index : index - 1);
  return true;
}

bool ObjReader::read_corner(std::string_view token) {
  const size_t slash = std::min(token.find('/'), token.size());
  int64_t index = 0;
  uint32_t vertex = 0;
  if (!scanner_.parse_integer(token.substr(0, slash), "the number of a vertex", index)) return false;
  if (!resolve(index, mesh_.positions.size(), "vertex", vertex)) return false;
  uint32_t uv = kNoUv;
  if (slash < token.size()) {
    const std::string_view tail = token.substr(slash + 1);
    const std::string_view number = tail.substr(0, tail.find('/'));
    if (!number.empty()) {
      if (!scanner_.parse_integer(number, "the number of a texture coordinate", index)) return false;
      if (!resolve(index, mesh_.uv.size(), "texture coordinate", uv)) return false;
    }
  }
  mesh_.face_vertices.push_back(vertex);
  mesh_.face_uv.push_back(uv);
  return true;
}

void ObjReader::check_face(size_t first) {
  const size_t size = mesh_.face_vertices.size() - first;
  if (size < 3) {
    scanner_.report(fmt::format("a face needs 3 corners, this one has {}", size));
    return;
  }
  if (distinct_corners(std::span(mesh_.face_vertices).subspan(first)) < 3) {
    scanner_.report("a face needs 3 different vertices");
  }
  const auto uv = mesh_.face_uv.begin() + static_cast<std::ptrdiff_t>(first);
  const auto without = std::count(uv, mesh_.face_uv.end(), kNoUv);
  if (without != 0 && without != static_cast<std::ptrdiff_t>(size)) {
    scanner_.report("either all corners of a face have texture coordinates or none of them");
  }
}

void ObjReader::read_face() {
  const size_t first = mesh_.face_vertices.size();
  const int line = scanner_.line();
  std::string_view token;
  bool good = true;
  while (good && scanner_.next_token(token)) good = read_corner(token);
  if (good) check_face(first);
  if (current_group_ < 0) {
    current_group_ = static_cast<int>(mesh_.groups.size());
    mesh_.groups.push_back("default");
    group_numbers_.emplace("default", static_cast<uint16_t>(current_group_));
  }
  mesh_.face_sizes.push_back(static_cast<uint32_t>(mesh_.face_vertices.size() - first));
  mesh_.face_groups.push_back(static_cast<uint16_t>(current_group_));
  for (const auto& [names, current] :
       {std::pair(&mesh_.objects, current_object_), std::pair(&mesh_.materials, current_material_)}) {
    if (current >= 0) names->faces.resize(mesh_.face_sizes.size() - 1);
    if (current >= 0) names->faces.push_back(static_cast<uint16_t>(current));
  }
  face_lines_.push_back(line);
}

void ObjReader::read_group(std::string name) {
  if (name.empty()) name = "default";
  const auto [entry, is_new] = group_numbers_.emplace(name, static_cast<uint16_t>(mesh_.groups.size()));
  if (is_new) {
    if (mesh_.groups.size() > std::numeric_limits<uint16_t>::max()) {
      scanner_.report("more than 65536 groups");
      group_numbers_.erase(entry);
      return;
    }
    mesh_.groups.push_back(std::move(name));
  }
  current_group_ = entry->second;
}

void ObjReader::read_name(const std::string& name, ControlMesh::FaceNames& all, int& current) {
  // Faces before the first name have the name "".
  if (all.names.empty()) all.names.emplace_back();
  auto& numbers = name_numbers_[&all];
  if (numbers.empty()) numbers.emplace("", 0);
  const auto [known, is_new] = numbers.emplace(name, static_cast<int>(all.names.size()));
  current = known->second;
  if (!is_new) return;
  if (all.names.size() > std::numeric_limits<uint16_t>::max())
    return scanner_.report("more than 65535 objects or materials");
  all.names.push_back(name);
}

std::vector<int64_t> ObjReader::read_tag_integers(int64_t count) {
  std::vector<int64_t> values;
  int64_t value = 0;
  while (static_cast<int64_t>(values.size()) < count &&
         scanner_.integer("a whole number of the tag", value)) {
    values.push_back(value);
  }
  if (static_cast<int64_t>(values.size()) < count) values.clear();
  return values;
}

/// Sharpness of each of `wanted` elements: one number for all, or one each.
std::vector<float> ObjReader::read_tag_sharpness(int64_t count, size_t wanted) {
  if (count != 1 && count != static_cast<int64_t>(wanted)) {
    scanner_.report(fmt::format("expected 1 or {} values of sharpness, got {}", wanted, count));
    return {};
  }
  std::vector<float> values;
  float value = 0;
  while (static_cast<int64_t>(values.size()) < count && scanner_.number("a sharpness", value)) {
    if (value < 0) scanner_.report(fmt::format("a sharpness may not be negative, got {}", value));
    values.push_back(value);
  }
  if (static_cast<int64_t>(values.size()) < count) return {};
  values.resize(wanted, values.front());
  return values;
}

void ObjReader::read_tag() {
  std::string_view name, sizes;
  const int line = scanner_.line();
  if (!scanner_.next_token(name) || !scanner_.next_token(sizes)) {
    scanner_.report("a tag needs a name and counts, as in: t crease 2/1/0 4 5 3.5");
    return;
  }
  int64_t counts[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    const size_t slash = std::min(sizes.find('/'), sizes.size());
    if (!scanner_.parse_integer(sizes.substr(0, slash), "tag counts, as in 2/1/0", counts[i])) return;
    sizes.remove_prefix(std::min(slash + 1, sizes.size()));
  }
  const auto refer = [&](std::vector<Reference>& references, int64_t index) {
    const bool fits = index >= 0 && index < kMaxIndex;
    references.push_back({fits ? static_cast<uint32_t>(index) : kNoUv, line});
    return references.back().index;
  };
  if (name == "crease") {
    const std::vector<int64_t> chain = read_tag_integers(counts[0]);
    if (chain.size() < 2) return scanner_.report("a crease needs 2 vertices or more");
    const std::vector<float> sharpness = read_tag_sharpness(counts[1], chain.size() - 1);
    for (size_t i = 0; i < sharpness.size(); ++i) {
      const uint32_t a = refer(vertex_references_, chain[i]);
      mesh_.creases.push_back({a, refer(vertex_references_, chain[i + 1]), sharpness[i]});
    }
  } else if (name == "corner") {
    const std::vector<int64_t> vertices = read_tag_integers(counts[0]);
    if (vertices.empty()) return scanner_.report("a corner tag needs at least one vertex");
    const std::vector<float> sharpness = read_tag_sharpness(counts[1], vertices.size());
    for (size_t i = 0; i < sharpness.size(); ++i) {
      mesh_.corners.push_back({refer(vertex_references_, vertices[i]), sharpness[i]});
    }
  } else if (name == "hole") {
    for (int64_t face : read_tag_integers(counts[0])) mesh_.holes.push_back(refer(face_references_, face));
  } else if (name == "interpolateboundary") {
    const std::vector<int64_t> rule = read_tag_integers(counts[0]);
    if (rule.size() != 1 || rule[0] < 0 || rule[0] > 2)
      return scanner_.report("expected a boundary rule 0, 1 or 2");
    mesh_.boundary_tag = static_cast<int>(rule[0]);
  } else if (name == "creasemethod") {
    mesh_.chaikin_creases = scanner_.rest() == "chaikin";
  } else if (name == "smoothtriangles") {
    mesh_.smooth_triangles = scanner_.rest() == "smooth";
  } else if (name.ends_with("edit")) {
    scanner_.report(fmt::format("hierarchical edits ({}) are not supported", quoted_excerpt(name)));
  }
}

void ObjReader::check_references() {
  size_t corner = 0;
  for (size_t face = 0; face < mesh_.face_sizes.size(); ++face) {
    for (uint32_t i = 0; i < mesh_.face_sizes[face]; ++i, ++corner) {
      if (mesh_.face_vertices[corner] >= mesh_.positions.size()) {
        scanner_.report_line(face_lines_[face],
                             fmt::format("vertex {} does not exist: the file has {}",
                                         mesh_.face_vertices[corner] + 1, mesh_.positions.size()));
      }
      if (mesh_.face_uv[corner] != kNoUv && mesh_.face_uv[corner] >= mesh_.uv.size()) {
        scanner_.report_line(face_lines_[face],
                             fmt::format("texture coordinate {} does not exist: the file has {}",
                                         mesh_.face_uv[corner] + 1, mesh_.uv.size()));
      }
    }
  }
  for (const Reference& r : vertex_references_) {
    if (r.index >= mesh_.positions.size()) {
      scanner_.report_line(
          r.line, fmt::format("tag vertices are numbered from 0 to {}", int64_t(mesh_.positions.size()) - 1));
    }
  }
  for (const Reference& r : face_references_) {
    if (r.index >= mesh_.face_sizes.size()) {
      scanner_.report_line(
          r.line, fmt::format("tag faces are numbered from 0 to {}", int64_t(mesh_.face_sizes.size()) - 1));
    }
  }
}

/// Faces without texture coordinates get (0, 0), unless no face has any.
void ObjReader::complete_uv() {
  const auto without = std::count(mesh_.face_uv.begin(), mesh_.face_uv.end(), kNoUv);
  if (without == static_cast<std::ptrdiff_t>(mesh_.face_uv.size())) {
    mesh_.face_uv.clear();
    mesh_.uv.clear();
  } else if (without > 0) {
    mesh_.uv.emplace_back(0.0f);
    std::replace(mesh_.face_uv.begin(), mesh_.face_uv.end(), kNoUv,
                 static_cast<uint32_t>(mesh_.uv.size() - 1));
  }
}

}  // namespace

int64_t obj_reading_bytes(const std::filesystem::path& path) {
  std::error_code unknown;
  const uintmax_t bytes = std::filesystem::file_size(path, unknown);
  return unknown ? 0 : 4 * static_cast<int64_t>(bytes);
}

ControlMesh read_obj(const std::filesystem::path& path) {
  const std::string text = read_text_file(path, kLongestFile);
  return ObjReader(text, path.string(), nullptr).read();
}

ControlMesh read_obj(const std::filesystem::path& path, const Job& job) {
  const std::string text = read_text_file(path, kLongestFile);
  job.check_stop();
  return ObjReader(text, path.string(), &job).read();
}

std::vector<V3f> read_obj_positions(const std::filesystem::path& path, const MeshOrder& order) {
  const std::string text = read_text_file(path, kLongestFile);
  ObjScanner scanner(text, path.string());
  std::vector<V3f> positions;
  ContentHasher faces;
  bool has_faces = false;
  std::vector<uint32_t> face;
  std::string_view keyword;
  while (scanner.next_statement(keyword)) {
    if (keyword == "v") positions.push_back(read_position(scanner));
    if (keyword != "f") continue;
    has_faces = true;
    read_face_vertices(scanner, positions.size(), face);
    faces.add(std::span<const uint32_t>(face));
  }
  if (positions.size() != order.vertices) {
    scanner.report_line(
        0, fmt::format("has {} vertices, but its cage has {}", positions.size(), order.vertices));
  } else if (has_faces && faces.digest() != order.faces) {
    scanner.report_line(0,
                        "has other faces than its cage, so its vertices may be in another order; export the "
                        "cage and its poses in the same way, or the poses without faces");
  }
  scanner.throw_if_any();
  return positions;
}

}  // namespace pelage
