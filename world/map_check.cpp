// SPDX-License-Identifier: Apache-2.0
#include "world/map_check.h"

#include <set>
#include <tuple>

#include "base/nearest_name.h"

namespace pelage {
namespace {

using Map = ParameterText::Map;

class MapChecker {
 public:
  MapChecker(const SceneDescription& scene, const std::map<std::string, Assets::Skin>& skins)
      : scene_(scene), skins_(skins) {}

  void check() {
    for (const auto& groom : scene_.grooms.items) {
      std::vector<Map> maps;
      if (groom.value.density) ValueReader<Field>::add_maps(*groom.value.density, maps);
      for (const OperatorList::Item& item : groom.value.operators.items) {
        for (const ParameterText& parameter : item.prototype->parameters())
          maps.insert(maps.end(), parameter.maps.begin(), parameter.maps.end());
      }
      check_strands(groom.name, groom.value, maps);
    }
    for (const auto& character : scene_.characters.items) {
      for (const PartParams& part : character.value.parts) {
        check_skin(part.skin.name, maps_of(part.material.name));
        for (const auto& groom : part.grooms.items)
          check_strands(groom.name, scene_.grooms.find(groom.name)->value, maps_of(groom.value.name));
      }
    }
    problems_.throw_if_any();
  }

 private:
  std::vector<Map> maps_of(const std::string& material) const {
    std::vector<Map> maps;
    std::visit(
        [&](const auto& params) {
          ValueReader<Field>::add_maps(params.color, maps);
          if constexpr (requires { params.opacity; }) ValueReader<Field>::add_maps(params.opacity, maps);
        },
        scene_.materials.find(material)->value);
    return maps;
  }

  void check_skin(const std::string& skin, const std::vector<Map>& maps) {
    if (!skins_.at(skin).cage.face_uv.empty()) return;
    const std::string mesh = scene_.skins.find(skin)->value.mesh.path.filename().string();
    complain(maps, "the mesh " + mesh + " of skin " + quote(skin) +
                       " has none; export the mesh with texture coordinates (vt lines), or");
  }

  void check_strands(const std::string& groom, const GroomParams& params, const std::vector<Map>& maps) {
    if (!params.skin.name.empty() && params.attach != Attachment::kNone)
      check_skin(params.skin.name, maps);
    else
      complain(maps, "the strands of groom " + quote(groom) + " follow no skin and have none;");
  }

  void complain(const std::vector<Map>& maps, const std::string& why) {
    for (const Map& map : maps) {
      if (!warned_.emplace(map.position.file, map.position.line, map.position.column, why).second) continue;
      problems_.add(map.position, "the map " + map.file.filename().string() +
                                      " is looked up by texture coordinates, but " + why +
                                      " use a number, noise, or a ramp along x, y or z instead");
    }
  }

  const SceneDescription& scene_;
  const std::map<std::string, Assets::Skin>& skins_;
  Problems problems_{20};
  std::set<std::tuple<std::string, int, int, std::string>> warned_;
};

}  // namespace

void check_maps(const SceneDescription& scene, const std::map<std::string, Assets::Skin>& skins) {
  MapChecker(scene, skins).check();
}

}  // namespace pelage
