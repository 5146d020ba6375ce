// SPDX-License-Identifier: Apache-2.0
#include "image/map_field.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/check.h"
#include "image/field_places.h"
#include "image/map_projection.h"
#include "image/udim.h"

namespace pelage {
namespace {

/// Index of a named channel in an image of `count` channels, -1 when there is none. Grey is used for r, g and
/// b.
int channel_index(MapChannel channel, int count) {
  const bool grey = count < 3;
  if (channel == MapChannel::kA) return count == 2 || count == 4 ? count - 1 : -1;
  return grey ? 0 : static_cast<int>(channel);
}

/// The image of a map, or one of its tiles.
struct Tile {
  std::shared_ptr<const Texture> texture;
  int channel = 0;
};

Tile load_tile(const MapForm& form, const AssetPath& file, TextureLibrary& textures) {
  // A single channel is data (lengths, masks), which is not stored with a display's transfer curve.
  const bool is_data = form.channel && form.space == ColorSpace::kAuto;
  Tile tile{textures.load(file, is_data ? ColorSpace::kLinear : form.space)};
  const int channels = tile.texture->channels();
  tile.channel = channel_index(form.channel.value_or(MapChannel::kR), channels);
  if (tile.channel < 0) {
    throw Error(ErrorKind::kInput, form.map.position,
                fmt::format("{}: has no channel 'a', only {}", file.path.string(), channels));
  }
  return tile;
}

struct MapNode final : Field::Node {
  explicit MapNode(MapForm f) : form(std::move(f)) {}

  float map(float stored) const { return form.range.x + (form.range.y - form.range.x) * stored; }
  float value(const FieldPoint& p) const override {
    return map(looked_up<float>(p, [](const Tile& tile, float u, float v, TextureWrap wrap) {
      return tile.texture->channel(u, v, tile.channel, wrap);
    }));
  }
  Rgb color(const FieldPoint& p) const override {
    if (form.channel) return Rgb(value(p));
    const Rgb stored = looked_up<Rgb>(p, [](const Tile& tile, float u, float v, TextureWrap wrap) {
      return tile.texture->color(u, v, wrap);
    });
    return {map(stored.x), map(stored.y), map(stored.z)};
  }
  FieldDependence dependence() const override {
    const bool face = form.projection == MapProjection::kFace;
    return {.surface = true,
            .rest = form.projection != MapProjection::kTexture && !face,
            .normal = form.projection == MapProjection::kTriplanar,
            .face = face};
  }
  std::pair<float, float> range() const override {
    const float a = map(lowest), b = map(highest);
    return {std::min(a, b), std::max(a, b)};
  }
  std::string print() const override;
  void collect_maps(std::vector<AssetPath>& maps, bool by_texture) const override {
    if (!by_texture || form.projection == MapProjection::kTexture) maps.push_back(form.map);
  }
  std::shared_ptr<const Node> with_textures(const FieldSources& sources) const override;

  MapForm form;
  std::optional<Projector> projector;  ///< empty: texture coordinates
  Tile whole;                          ///< for a map without tiles
  std::map<int, Tile> tiles;           ///< by number
  bool tiled = false;
  float lowest = 0,
        highest = 1;  ///< of the stored values; until the map is loaded, of the values it should have

 private:
  template <class T, class Look>
  T looked_up(const FieldPoint& p, const Look& look) const {
    PELAGE_CHECK(whole.texture != nullptr || tiled);
    if (!projector) return at<T>(p.u, p.v, look);
    std::array<MapLookup, 3> lookups;
    const size_t count = projector->lookups(p, lookups);
    if (count == 1) return at<T>(lookups[0].u, lookups[0].v, look);
    T sum(0);
    for (size_t i = 0; i < count; ++i) sum += at<T>(lookups[i].u, lookups[i].v, look) * lookups[i].weight;
    return sum;
  }
  template <class T, class Look>
  T at(float u, float v, const Look& look) const {
    if (tiled) {
      const auto tile = tiles.find(tile_at(u, v));
      if (tile == tiles.end()) return T(0);
      return look(tile->second, u - std::floor(u), v - std::floor(v), TextureWrap::kClamp);
    }
    if (form.wrap == MapWrap::kBlack && !(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return T(0);
    return look(whole, u, v, form.wrap == MapWrap::kRepeat ? TextureWrap::kRepeat : TextureWrap::kClamp);
  }
};

std::string MapNode::print() const {
  std::string text = fmt::format("{{map: {}", form.map.path.string());
  const auto add = [&](const char* key, const std::string& value) {
    text += fmt::format(", {}: {}", key, value);
  };
  if (form.channel) add("channel", ValueReader<MapChannel>::print(*form.channel));
  if (form.range != V2f(0, 1)) add("range", ValueReader<V2f>::print(form.range));
  if (form.space != ColorSpace::kAuto) add("space", ValueReader<ColorSpace>::print(form.space));
  if (form.wrap != MapWrap::kClamp) add("wrap", ValueReader<MapWrap>::print(form.wrap));
  if (form.projection != MapProjection::kTexture)
    add("projection", ValueReader<MapProjection>::print(form.projection));
  if (form.axis) add("axis", ValueReader<MapAxis>::print(*form.axis));
  if (form.center) add("center", ValueReader<V3f>::print(*form.center));
  if (form.size) add("size", ValueReader<V3f>::print(*form.size));
  return text + "}";
}

std::shared_ptr<const Field::Node> MapNode::with_textures(const FieldSources& sources) const {
  auto loaded = std::make_shared<MapNode>(form);
  loaded->tiled = !form.map.data && has_tiles(form.map.path);
  const auto load = [&](const std::filesystem::path& file) {
    Tile tile = load_tile(form, {file, form.map.position, form.map.data}, sources.textures);
    const auto [low, high] = tile.texture->range(tile.channel);
    const bool first = loaded->tiles.empty() && !loaded->whole.texture;
    loaded->lowest = first ? low : std::min(loaded->lowest, low);
    loaded->highest = first ? high : std::max(loaded->highest, high);
    return tile;
  };
  if (loaded->tiled) {
    for (int tile = kFirstTile; tile <= kLastTile; ++tile) {
      const std::filesystem::path file = udim_file(form.map.path, tile);
      std::error_code ignored;
      if (!std::filesystem::exists(file, ignored)) continue;
      Tile image = load(file);
      loaded->tiles.emplace(tile, std::move(image));
    }
    if (loaded->tiles.empty()) {
      throw Error(ErrorKind::kInput, form.map.position,
                  "no tile of the map exists: there is no file " +
                      udim_file(form.map.path, kFirstTile).string() + ", nor any other number up to " +
                      std::to_string(kLastTile));
    }
  } else {
    loaded->whole = load(form.map.path);
  }
  if (loaded->tiled || form.wrap == MapWrap::kBlack) {
    // Outside its image or its tiles, the map is 0.
    loaded->lowest = std::min(loaded->lowest, 0.0f);
    loaded->highest = std::max(loaded->highest, 0.0f);
  }
  if (form.projection == MapProjection::kTexture) return loaded;
  V3f center(0), size(1);
  if (form.projection != MapProjection::kFace) {
    const Box3f box = form.center && form.size ? Box3f()
                                               : bounds_for("a projection without `center` and `size`",
                                                            form.map.position, sources);
    center = form.center.value_or(box.isEmpty() ? V3f(0) : box.center());
    size = form.size.value_or(box.isEmpty() ? V3f(1) : box.size());
    // A flat skin has no extent in one direction.
    for (int axis = 0; axis < 3; ++axis) size[axis] = std::max(size[axis], 1e-6f * max_component(size));
    if (!(max_component(size) > 0)) size = V3f(1);
  }
  const bool round = form.projection == MapProjection::kCylinder || form.projection == MapProjection::kSphere;
  loaded->projector.emplace(form.projection, form.axis.value_or(round ? MapAxis::kY : MapAxis::kZ), center,
                            size);
  return loaded;
}

}  // namespace

Field map_field(MapForm form) { return Field(std::make_shared<MapNode>(std::move(form))); }

}  // namespace pelage
