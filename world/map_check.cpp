// SPDX-License-Identifier: Apache-2.0
#include "world/map_check.h"

#include <algorithm>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "image/udim.h"

namespace pelage {
namespace {

using Map = ParameterText::Map;

/// A map or ramp that is looked up by texture coordinates.
struct Lookup {
  std::string what;  ///< "the map spots.png"
  SourcePosition position;
  bool ends_at_border = false;       ///< a map of one image whose border continues outside
  std::filesystem::path tiles = {};  ///< of a map of UDIM tiles; otherwise empty
};

/// Adds the lookups of a parameter or field, given as printed text. `position`: of the operator, material or
/// groom, for ramps; maps have positions of their own.
void add_lookups(const std::string& text, const std::vector<Map>& maps, const SourcePosition& position,
                 std::vector<Lookup>& lookups) {
  const bool wraps = text.find(", wrap: ") != std::string::npos;
  for (const Map& map : maps) {
    const bool tiled = has_tiles(map.file);
    lookups.push_back({"the map " + map.file.filename().string(), map.position, !wraps && !tiled,
                       tiled ? map.file : std::filesystem::path()});
  }
  for (const char* axis : {"u", "v"}) {
    if (text.find(std::string("{ramp: {along: ") + axis + ",") != std::string::npos)
      lookups.push_back({std::string("a ramp along ") + axis, position, false});
  }
}

void add_lookups(const Field& field, const SourcePosition& position, std::vector<Lookup>& lookups) {
  std::vector<Map> maps;
  ValueReader<Field>::add_maps(field, maps);
  add_lookups(ValueReader<Field>::print(field), maps, position, lookups);
}

/// The tiles in which the middles of faces lie.
std::set<int> tiles_of(const ControlMesh& cage) {
  std::set<int> tiles;
  size_t corner = 0;
  for (const uint32_t size : cage.face_sizes) {
    V2f middle(0);
    for (const size_t end = corner + size; corner < end; ++corner)
      middle += cage.uv[cage.face_uv[corner]] / static_cast<float>(size);
    tiles.insert(tile_at(middle.x, middle.y));
  }
  return tiles;
}

class MapChecker {
 public:
  MapChecker(const SceneDescription& scene, const std::map<std::string, Assets::Skin>& skins,
             Progress& progress)
      : scene_(scene), skins_(skins), progress_(progress) {}

  void check() {
    for (const auto& groom : scene_.grooms.items) {
      std::vector<Lookup> lookups;
      if (groom.value.density) add_lookups(*groom.value.density, groom.position, lookups);
      for (const OperatorList::Item& item : groom.value.operators.items) {
        for (const ParameterText& parameter : item.prototype->parameters())
          add_lookups(parameter.text, parameter.maps, item.position, lookups);
      }
      check_strands(groom.name, groom.value, lookups);
    }
    for (const auto& character : scene_.characters.items) {
      for (const PartParams& part : character.value.parts) {
        check_skin(part.skin.name, lookups_of(part.material.name));
        for (const auto& groom : part.grooms.items)
          check_strands(groom.name, scene_.grooms.find(groom.name)->value, lookups_of(groom.value.name));
      }
    }
    problems_.throw_if_any();
  }

 private:
  std::vector<Lookup> lookups_of(const std::string& material) const {
    std::vector<Lookup> lookups;
    const auto& named = *scene_.materials.find(material);
    std::visit(
        [&](const auto& params) {
          add_lookups(params.color, named.position, lookups);
          if constexpr (requires { params.opacity; }) add_lookups(params.opacity, named.position, lookups);
        },
        named.value);
    return lookups;
  }

  void check_skin(const std::string& skin, const std::vector<Lookup>& lookups) {
    const ControlMesh& cage = skins_.at(skin).cage;
    if (!cage.face_uv.empty()) {
      check_tiles(skin, cage, lookups);
      return check_range(skin, cage, lookups);
    }
    const std::string mesh = scene_.skins.find(skin)->value.mesh.path.filename().string();
    complain(lookups, "the mesh " + mesh + " of skin " + quote(skin) +
                          " has none; export the mesh with texture coordinates (vt lines), or");
  }

  /// A tile belongs to a skin if the middle of a face lies in it.
  void check_tiles(const std::string& skin, const ControlMesh& cage, const std::vector<Lookup>& lookups) {
    std::set<int> needed;
    for (const Lookup& lookup : lookups) {
      if (lookup.tiles.empty()) continue;
      if (needed.empty()) needed = tiles_of(cage);
      for (const int tile : needed) {
        const std::filesystem::path file = udim_file(lookup.tiles, tile);
        std::error_code ignored;
        if (tile > 0 && std::filesystem::exists(file, ignored)) continue;
        if (!warned_.emplace(lookup.position.file, lookup.position.line, lookup.position.column, skin).second)
          break;
        problems_.add(lookup.position,
                      tile > 0 ? lookup.what + " has no tile " + std::to_string(tile) + ", which skin " +
                                     quote(skin) + " needs: no such file " + file.string()
                               : lookup.what + ": skin " + quote(skin) +
                                     " has texture coordinates outside all UDIM tiles (u from "
                                     "0 to 10, v from 0 up)");
        break;
      }
    }
  }

  void check_range(const std::string& skin, const ControlMesh& cage, const std::vector<Lookup>& lookups) {
    constexpr float kRounding = 1e-3f;
    Imath::Box2f range;
    for (const uint32_t corner : cage.face_uv) range.extendBy(cage.uv[corner]);
    const float excess = std::max({-range.min.x, -range.min.y, range.max.x - 1, range.max.y - 1});
    if (!(excess > kRounding)) return;
    for (const auto& [what, at, ends_at_border, tiles] : lookups) {
      if (!ends_at_border || !warned_.emplace(at.file, at.line, at.column, what + skin).second) continue;
      progress_.warn(fmt::format(
          "{}: {} covers texture coordinates from 0 to 1, but those of skin {} reach from ({:g}, {:g}) to "
          "({:g}, {:g}): its border continues outside (`wrap: black` ends it there, `wrap: repeat` repeats "
          "the "
          "image, and <UDIM> in its name reads tiles)",
          to_string(at), what, quote(skin), range.min.x, range.min.y, range.max.x, range.max.y));
    }
  }

  void check_strands(const std::string& groom, const GroomParams& params,
                     const std::vector<Lookup>& lookups) {
    if (!params.skin.name.empty() && params.attach != Attachment::kNone)
      check_skin(params.skin.name, lookups);
    else
      complain(lookups, "the strands of groom " + quote(groom) + " follow no skin and have none;");
  }

  void complain(const std::vector<Lookup>& lookups, const std::string& why) {
    for (const auto& [what, at, ends_at_border, tiles] : lookups) {
      if (!warned_.emplace(at.file, at.line, at.column, what + why).second) continue;
      problems_.add(at, what + " is looked up by texture coordinates, but " + why +
                            (what.starts_with("the map") ? " give the map a `projection`, or" : "") +
                            " use a number, noise, or a ramp along x, y or z instead");
    }
  }

  const SceneDescription& scene_;
  const std::map<std::string, Assets::Skin>& skins_;
  Progress& progress_;
  Problems problems_{20};
  std::set<std::tuple<std::string, int, int, std::string>> warned_;
};

}  // namespace

void check_maps(const SceneDescription& scene, const std::map<std::string, Assets::Skin>& skins,
                Progress& progress) {
  MapChecker(scene, skins, progress).check();
}

}  // namespace pelage
