// SPDX-License-Identifier: Apache-2.0
// Curves, meshes and the shapes of area lights.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "rib/scene/rib_curve_reader.h"
#include "rib/scene/rib_interpreter.h"
#include "rib/scene/rib_surfaces.h"

namespace pelage {
namespace {

// Equal texts mean equal shaders.
std::string content_of(const RibShader& shader) {
  std::string text = shader.name + "\n";
  for (const RibSetting& setting : shader.settings) {
    text += setting.type + " " + setting.name;
    for (const float x : setting.numbers) text += fmt::format(" {}", x);
    for (const std::string& s : setting.strings) text += fmt::format(" {}:{}", s.size(), s);
    text += "\n";
  }
  return text;
}

std::string name_of(const RibShader* shader, bool fibre) {
  if (!shader) return fibre ? "hair" : "surface";
  for (const char* key : {"name", "__name"}) {
    const RibSetting* name = shader->find(key);
    if (name && name->strings.size() == 1 && !name->strings[0].empty()) return name->strings[0];
  }
  return shader->name.empty() ? "surface" : shader->name;
}

}  // namespace

std::string RibInterpreter::unique_name(const char* kind, std::string wanted) {
  // Names become layers of pictures and keys of scenes.
  for (char& c : wanted) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '_';
  }
  if (wanted.empty()) wanted = "unnamed";
  if (wanted.size() > 100) wanted.resize(100);
  const std::string prefix = std::string(kind) + " ";
  std::string name = wanted;
  // Numbers go on where they were, because thousands of lights may have the same name.
  for (int& n = next_numbers_[prefix + wanted]; !names_.insert(prefix + name).second;)
    name = wanted + "." + std::to_string(n++ + 2);
  return name;
}

void RibInterpreter::count_points(const RibStatement& request, size_t points) {
  points_ += points;
  if (points_ > options_.max_points)
    request.fail(fmt::format("the file has more than {} points", options_.max_points));
}

std::string RibInterpreter::material_key(const Look& look) const {
  // A shader that Pelage wrote has its own colour.
  const bool whole = now_.surface && now_.surface->find("pelage");
  const Rgb color = whole ? Rgb(1) : now_.color;
  return fmt::format("{} {} {} {} {} {} {}\n", look.fibre, look.strand_color && !whole,
                     look.strand_opacity && !whole, color.x, color.y, color.z, whole ? 1 : now_.opacity) +
         (now_.surface ? content_of(*now_.surface) : "");
}

size_t RibInterpreter::material(const Look& look) {
  const auto [known, is_new] = materials_.try_emplace(material_key(look), scene_.materials.size());
  if (is_new) {
    RibMaterial material;
    material.name = unique_name("material", name_of(now_.surface.get(), look.fibre));
    material.shader = now_.surface;
    material.color = now_.color;
    material.fibre = look.fibre;
    material.strand_color = look.strand_color;
    material.opacity = now_.opacity;
    material.strand_opacity = look.strand_opacity;
    scene_.materials.push_back(std::move(material));
  }
  return known->second;
}

bool RibInterpreter::is_flattened(const SourcePosition& position, const RibTransform& transform) {
  if (is_usable(transform)) return false;
  warn_once("flattened", position, "things whose transform has no inverse are dropped");
  return true;
}

void RibInterpreter::warn_of_curves(const RibStatement& request, const RibCurveSet& set) {
  warn_undeclared(request, set.undeclared);
  const SourcePosition& at = request.position();
  for (const std::string& name : set.unsupported)
    warn_once("strings " + name, at, "parameter " + quote(name) + " of Curves consists of strings; skipped");
  for (const std::string& why : set.misfits) warn_once("misfit " + why, at, why + "; skipped");
  if (!set.has_width)
    warn_once("width", at, "curves without \"width\" or \"constantwidth\" have the width 1");
  if (set.negative_widths) warn_once("negative width", at, "negative widths of curves count as 0");
  if (set.ribbons)
    warn_once("ribbons", at,
              "curves with normals \"N\" are flat ribbons; Pelage renders them as round strands");
  warn_of_visibility(request);
  drop("dropped curves whose points do not form whole segments", at, set.unusable);
}

void RibInterpreter::warn_of_visibility(const RibStatement& request) {
  if (!now_.seen_by_camera)
    warn_once("camera visibility", request.position(),
              "Attribute \"visibility\" \"camera\" 0 hides lights only; this is visible");
}

void RibInterpreter::curves(const Call& call) {
  RibCurveSet set = read_curves(call.samples, context_.declarations, now_.basis);
  RibStatement& request = call.request();
  warn_of_curves(request, set);
  if (set.strands.ids.empty() || is_flattened(request.position(), now_.to_world)) return;
  count_points(request, set.strands.points.size() / 4);
  const Look look{true, set.has_color, set.has_opacity};
  const size_t own_material = material(look);
  const std::string name = now_.name.empty() ? "hair" : now_.name;
  const Rgb& tint = now_.tint;
  const std::string key = fmt::format("{}\n{} {} {} {}", material_key(look), tint.x, tint.y, tint.z, name);
  const auto [coat, is_new] = coats_.try_emplace(key, scene_.coats.size());
  if (is_new) {
    scene_.coats.emplace_back();
    scene_.coats.back().name = unique_name("coat", name);
    scene_.coats.back().material = own_material;
    scene_.coats.back().tint = tint;
  }
  if (!options_.geometry) return;
  uint64_t& next = context_.next_ids[key];
  if (!set.has_ids) {
    for (uint64_t& id : set.strands.ids) id = next++;
  }
  size_t dropped = 0;
  const StrandArrays strands =
      to_world(std::move(set.strands), call.times, now_.to_world, context_.shutter, dropped);
  drop("dropped strands without extent, or with points that are not finite", request.position(), dropped);
  batches_.add(coat->second, strands);
}

void RibInterpreter::keep_batch(size_t coat, Strands batch) {
  if (take_) {
    take_(coat, std::move(batch));
    return;
  }
  RibCoat& own = scene_.coats[coat];
  if (own.scale.width == 0) own.scale = scale_of(batch);
  kept_bytes_ += batch.bytes();
  if (options_.reserve) options_.reserve(kept_bytes_);
  own.batches.push_back(std::make_shared<const Strands>(std::move(batch)));
}

void RibInterpreter::mesh(const Call& call) {
  RibMesh mesh = read_mesh(call.samples, context_.declarations);
  if (now_.bilinear && mesh.scheme == SubdivisionScheme::kNone) mesh.scheme = SubdivisionScheme::kBilinear;
  add_mesh(call, std::move(mesh));
}

void RibInterpreter::patch(const Call& call) {
  RibStatement& request = call.request();
  const auto& a = request.arguments;
  if (now_.area && request.name == "Patch" && !a.empty() && !a[0].is_number() &&
      a[0].strings[0] == "bilinear") {
    // The corners of a patch are in rows.
    RibMesh mesh = read_patches(call.samples.first(1), context_.declarations, now_.basis_u, now_.basis);
    if (mesh.cage.positions.size() == 4) std::swap(mesh.cage.positions[2], mesh.cage.positions[3]);
    add_mesh(call, std::move(mesh));
    return;
  }
  add_mesh(call, read_patches(call.samples, context_.declarations, now_.basis_u, now_.basis));
}

void RibInterpreter::quadric(const Call& call) {
  RibStatement& request = call.request();
  if (!now_.area || request.name != "Sphere") {
    add_mesh(call, read_quadric(call.samples));
    return;
  }
  if (request.arguments.empty() || !request.arguments[0].is_number() || request.arguments[0].size() == 0)
    request.fail("expected a radius");
  const float radius = std::abs(request.arguments[0].number(0));
  if (!(radius > 0 && radius < 1e18f)) request.fail("the radius must be greater than 0");
  area_light(RibLight::Shape::kSphere, radius, {});
}

void RibInterpreter::add_mesh(const Call& call, RibMesh mesh) {
  RibStatement& request = call.request();
  for (const std::string& what : mesh.ignored)
    warn_once("mesh " + what, request.position(), what + ": not supported; ignored");
  if (mesh.cage.face_sizes.empty()) {
    warn_once("no faces", request.position(), request.name + ": a mesh without faces is skipped");
    return;
  }
  if (is_flattened(request.position(), now_.to_world)) return;
  count_points(request, mesh.samples.size() * (mesh.cage.positions.size() + mesh.cage.face_vertices.size()));
  if (now_.area) {
    std::vector<V3f> corners;
    const M44f matrix = now_.to_world.at(0);
    const bool one_face = mesh.cage.face_count() == 1;
    for (const V3f& p : mesh.cage.positions) corners.push_back(p * matrix);
    area_light(one_face ? RibLight::Shape::kPolygon : RibLight::Shape::kMesh, 0, std::move(corners));
    return;
  }
  warn_of_visibility(request);
  if (now_.opacity == 0) {
    warn_once("invisible mesh", request.position(), "meshes with an Opacity of 0 are skipped");
    return;
  }
  if (now_.opacity < 1)
    warn_once("opaque mesh", request.position(), "Opacity has no effect on meshes, only on curves");
  const size_t own_material = material(Look{});
  if (!options_.geometry) return;
  RibSkin skin;
  skin.name = unique_name("mesh", now_.name.empty() ? "mesh" : now_.name);
  skin.material = own_material;
  skin.tint = now_.tint;
  mesh.cage.chaikin_creases |= now_.chaikin_creases;
  skin.position = request.position();
  skin.scheme = mesh.scheme;
  skin.boundary = mesh.boundary;
  const size_t count = std::max(mesh.samples.size(), now_.to_world.sample_count());
  for (const double time : context_.shutter.keys(count)) {
    const auto after = std::upper_bound(call.times.begin(), call.times.end(), time);
    const size_t last = mesh.samples.size() - 1;
    const size_t high = std::min(static_cast<size_t>(after - call.times.begin()), last);
    const size_t low = after == call.times.begin() ? 0 : static_cast<size_t>(after - call.times.begin()) - 1;
    const float t = high > low
                        ? static_cast<float>((time - call.times[low]) / (call.times[high] - call.times[low]))
                        : 0.0f;
    const M44f matrix = now_.to_world.at(time);
    std::vector<V3f> key;
    for (size_t i = 0; i < mesh.cage.positions.size(); ++i) {
      const V3f &a = mesh.samples[std::min(low, last)][i], &b = mesh.samples[high][i];
      const V3f p(interpolate(a.x, b.x, t), interpolate(a.y, b.y, t), interpolate(a.z, b.z, t));
      key.push_back(matrix == M44f() ? p : p * matrix);
    }
    skin.keys.push_back(std::move(key));
  }
  mesh.cage.positions = mesh.rest.empty() ? skin.keys.front() : std::move(mesh.rest);
  kept_bytes_ += mesh.cage.bytes() + skin.keys.size() * skin.keys.front().size() * sizeof(V3f);
  if (options_.reserve) options_.reserve(kept_bytes_);
  skin.cage = std::move(mesh.cage);
  scene_.skins.push_back(std::move(skin));
}

}  // namespace pelage
