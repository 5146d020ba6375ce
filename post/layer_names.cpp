// SPDX-License-Identifier: Apache-2.0
#include "post/layer_names.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

namespace pelage {
namespace {

/// Lower case, letters and digits only: "Motion_Vectors" is "motionvectors".
std::string plain(const std::string& name) {
  std::string result;
  for (unsigned char c : name) {
    if (std::isalnum(c)) result += static_cast<char>(std::tolower(c));
  }
  return result;
}

std::string last_segment(const std::string& layer) {
  const size_t dot = layer.rfind('.');
  return dot == std::string::npos ? layer : layer.substr(dot + 1);
}

/// Removes the first occurrence of `what` from `text`, with the surrounding punctuation.
std::string without(const std::string& text, const std::string& what) {
  const std::string from = plain(text), piece = plain(what);
  const size_t at = piece.empty() ? std::string::npos : from.find(piece);
  return at == std::string::npos ? from : from.substr(0, at) + from.substr(at + piece.size());
}

const char* const kMotionLayers[] = {"forward",       "motion",  "motionvector", "motionvectors", "motion2d",
                                     "motionforward", "vectors", "vector",       "velocity",      "mv"};
const char* const kDepthLayers[] = {"depth", "z", "zdepth", "depthz"};

/// Layers that contain the picture itself, if it has no channels without a layer.
const char* const kBeautyLayers[] = {"combined", "beauty", "rgba"};

/// Layers that must not be averaged, and prefixes of such names.
const std::set<std::string> kDataLayers = {
    "n",      "nn",       "ng",       "ns",         "normal",  "normals", "p",        "pos",      "position",
    "pworld", "pref",     "point",    "tangent",    "uv",      "st",      "texcoord", "root",     "id",
    "ids",    "objectid", "material", "materialid", "indexob", "indexma", "forward",  "backward", "motion",
    "vector", "vectors",  "velocity", "mv",         "z",       "depth",   "zback",    "zdepth",   "depthz"};
const char* const kDataBeginnings[] = {"disparity", "parallax", "motion", "normal", "crypto"};

bool means_data(const std::string& plain_name) {
  if (kDataLayers.contains(plain_name)) return true;
  return std::any_of(std::begin(kDataBeginnings), std::end(kDataBeginnings),
                     [&](const char* beginning) { return plain_name.starts_with(beginning); });
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> pieces{""};
  for (char c : text) {
    if (c == separator) {
      pieces.emplace_back();
    } else {
      pieces.back() += c;
    }
  }
  return pieces;
}

NamedChannel name_channel(const ExrPart& part, const std::string& name) {
  NamedChannel result;
  result.view = part.view;
  std::vector<std::string> pieces = split(name, '.');
  if (part.view.empty() && !part.multi_view.empty()) {
    // With several views, a name without a view belongs to the default one; otherwise the view precedes the
    // last piece.
    if (pieces.size() == 1) {
      result.view = part.multi_view.front();
    } else {
      const auto view = pieces.end() - 2;
      if (std::find(part.multi_view.begin(), part.multi_view.end(), *view) != part.multi_view.end()) {
        result.view = *view;
        pieces.erase(view);
      }
    }
  }
  result.component = pieces.back();
  for (size_t i = 0; i + 1 < pieces.size(); ++i) result.layer += (i ? "." : "") + pieces[i];
  return result;
}

}  // namespace

std::vector<NamedChannel> name_channels(const std::vector<ExrPart>& parts) {
  std::vector<NamedChannel> channels;
  for (size_t p = 0; p < parts.size(); ++p) {
    for (size_t c = 0; c < parts[p].channels.size(); ++c) {
      NamedChannel channel = name_channel(parts[p], parts[p].channels[c].name);
      channel.part = p;
      channel.channel = c;
      channel.type = parts[p].channels[c].type;
      channels.push_back(std::move(channel));
    }
  }
  return channels;
}

std::vector<std::string> views_of(const std::vector<NamedChannel>& channels,
                                  const std::vector<ExrPart>& parts) {
  std::vector<std::string> views;
  const auto add = [&](const std::string& view) {
    if (std::find(views.begin(), views.end(), view) == views.end()) views.push_back(view);
  };
  for (const ExrPart& part : parts) {
    for (const std::string& view : part.multi_view) add(view);
  }
  for (const NamedChannel& channel : channels) add(channel.view);
  return views;
}

LayerFinder::LayerFinder(const std::vector<NamedChannel>& channels, const std::vector<ExrPart>& parts,
                         std::string view, const LayerChoice& choice)
    : channels_(channels),
      parts_(parts),
      view_(std::move(view)),
      choice_(choice),
      motion_(find_motion()),
      depth_(find_depth()),
      mattes_(find_mattes()) {
  for (const RankedMatte& matte : mattes_) {
    for (const auto& rank : matte.ranks) ranked_.insert({rank.id, rank.coverage});
  }
}

bool LayerFinder::is_called(const NamedChannel& channel, const std::string& plain_layer) const {
  if (plain(channel.layer) == plain_layer || plain(last_segment(channel.layer)) == plain_layer) return true;
  // Names without a layer in a part of their own, and "forward_left" in a part of the left view.
  const ExrPart& part = parts_[channel.part];
  if (!channel.layer.empty() || part.name.empty()) return false;
  return plain(part.name) == plain_layer || plain(last_segment(part.name)) == plain_layer ||
         without(part.name, view_) == plain_layer;
}

std::string LayerFinder::name_in_file(const NamedChannel& channel) const {
  const std::string& part = parts_[channel.part].name;
  const bool needs_part = channel.layer.empty() && parts_.size() > 1 && !part.empty();
  return needs_part ? part + "." + channel.component : channel.name();
}

/// Searches by the channel's own name first, then by part name and channel name, with or without the view.
std::optional<size_t> LayerFinder::find_channel(const std::string& view, const std::string& name) const {
  std::optional<size_t> in_part;
  for (size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].view != view) continue;
    if (plain(channels_[i].name()) == plain(name)) return i;
    const std::string in_file = name_in_file(channels_[i]);
    if (!in_part && (plain(in_file) == plain(name) || without(in_file, view) == plain(name))) in_part = i;
  }
  return in_part;
}

std::optional<size_t> LayerFinder::find(const std::string& view, const std::string& plain_layer,
                                        const std::vector<std::string>& components) const {
  for (const std::string& component : components) {
    for (size_t i = 0; i < channels_.size(); ++i) {
      if (channels_[i].view == view && plain(channels_[i].component) == component &&
          is_called(channels_[i], plain_layer))
        return i;
    }
  }
  return {};
}

std::optional<std::pair<size_t, size_t>> LayerFinder::vectors_in(const std::string& view,
                                                                 const std::string& name) const {
  const std::vector<std::string> both = split(name, ',');
  if (both.size() == 2) {
    const auto u = find_channel(view, both[0]), v = find_channel(view, both[1]);
    return u && v ? std::optional(std::pair(*u, *v)) : std::nullopt;
  }
  const char* const pairs[][2] = {{"u", "v"}, {"x", "y"}, {"r", "g"}, {"red", "green"}};
  for (const auto& pair : pairs) {
    const auto u = find(view, plain(name), {pair[0]}), v = find(view, plain(name), {pair[1]});
    if (u && v) return std::pair(*u, *v);
  }
  return {};
}

std::optional<std::pair<size_t, size_t>> LayerFinder::vectors(const std::string& name) const {
  return in_view_or_none([&](const std::string& view) { return vectors_in(view, name); });
}

std::optional<std::pair<size_t, size_t>> LayerFinder::find_motion() const {
  if (!choice_.motion.empty()) return vectors(choice_.motion);
  for (const char* layer : kMotionLayers) {
    if (const auto found = vectors(layer)) return found;
  }
  return {};
}

std::optional<size_t> LayerFinder::find_depth() const {
  return in_view_or_none([&](const std::string& view) { return depth_in(view); });
}

std::optional<size_t> LayerFinder::depth_in(const std::string& view) const {
  const std::vector<std::string> components = {"z", "depth", "r", "y", "v", "x", "red"};
  if (!choice_.depth.empty()) {
    const auto channel = find_channel(view, choice_.depth);
    return channel ? channel : find(view, plain(choice_.depth), components);
  }
  // A Z without a layer, unless there are X and Y too: then it is the third component of a vector.
  for (size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].view != view || !channels_[i].layer.empty()) continue;
    const std::string name = plain(channels_[i].component);
    const bool has_x = std::any_of(channels_.begin(), channels_.end(), [&](const NamedChannel& c) {
      return c.part == channels_[i].part && c.view == view && c.layer.empty() && plain(c.component) == "x";
    });
    if (name == "depth" || (name == "z" && !has_x)) return i;
  }
  for (const char* layer : kDepthLayers) {
    if (const auto found = find(view, layer, components)) return found;
  }
  return {};
}

std::optional<size_t> LayerFinder::alpha() const {
  const auto bare = bare_alpha();
  if (bare) return bare;
  for (const char* layer : kBeautyLayers) {
    if (const auto found = find(view_, layer, {"a", "alpha"})) return found;
  }
  return {};
}

std::optional<size_t> LayerFinder::bare_alpha() const {
  for (size_t i = 0; i < channels_.size(); ++i) {
    const NamedChannel& c = channels_[i];
    if (!is_here(i) || !c.layer.empty()) continue;
    const std::string name = plain(c.component);
    const bool is_beauty =
        c.part == 0 || std::any_of(channels_.begin(), channels_.end(), [&](const auto& other) {
          return other.part == c.part && other.layer.empty() && plain(other.component) == "r";
        });
    if ((name == "a" || name == "alpha") && (is_beauty || parts_[c.part].channels.size() == 1)) return i;
  }
  return {};
}

bool LayerFinder::is_listed(const NamedChannel& channel, const std::vector<std::string>& names) const {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return plain(channel.name()) == plain(name) || is_called(channel, plain(name));
  });
}

bool LayerFinder::has(const std::string& name) const {
  return std::any_of(channels_.begin(), channels_.end(),
                     [&](const NamedChannel& c) { return is_listed(c, {name}); });
}

LayerRole LayerFinder::role(size_t i) const {
  const NamedChannel& channel = channels_[i];
  if (ranked_.contains(i)) return LayerRole::kMatte;
  if (channel.type == ChannelType::kUint) return LayerRole::kData;
  if (is_listed(channel, choice_.data)) return LayerRole::kData;
  if (is_listed(channel, choice_.colors)) return LayerRole::kColor;
  if (depth() == i) return LayerRole::kDepth;
  if (const auto m = motion(); m && (m->first == i || m->second == i)) return LayerRole::kData;
  const std::string component = plain(channel.component);
  if (channel.layer.empty() && (component == "z" || component == "zback")) return LayerRole::kDepth;
  const bool bare_in_part = channel.layer.empty() && !parts_[channel.part].name.empty();
  const std::string layer = bare_in_part ? without(parts_[channel.part].name, view_) : plain(channel.layer);
  const bool is_data = means_data(layer) || means_data(plain(last_segment(channel.layer))) ||
                       (channel.layer.empty() && (component == "id" || component == "depth"));
  return is_data ? LayerRole::kData : LayerRole::kColor;
}

std::vector<RankedMatte> LayerFinder::find_mattes() const {
  std::set<std::string> names;
  for (const ExrPart& part : parts_) {
    for (const auto& [key, value] : part.attributes) {
      const std::string* name = std::get_if<std::string>(&value);
      if (name && key.starts_with("cryptomatte/") && key.ends_with("/name")) names.insert(*name);
    }
  }
  std::vector<RankedMatte> mattes;
  for (const std::string& name : names) {
    // Layers name00, name01 ... contain two ranks each: id and coverage in R and G, then in B and A.
    std::map<std::string, std::map<char, size_t>> layers;
    for (size_t i = 0; i < channels_.size(); ++i) {
      const NamedChannel& c = channels_[i];
      const std::string layer = c.layer.empty() ? parts_[c.part].name : c.layer;
      const std::string component = plain(c.component);
      if (!is_here(i) || c.type != ChannelType::kFloat || component.empty()) continue;
      if (layer.size() == name.size() + 2 && layer.starts_with(name)) layers[layer][component.front()] = i;
    }
    RankedMatte matte;
    for (const auto& [layer, c] : layers) {
      if (c.contains('r') && c.contains('g')) matte.ranks.push_back({c.at('r'), c.at('g')});
      if (c.contains('b') && c.contains('a')) matte.ranks.push_back({c.at('b'), c.at('a')});
    }
    if (!matte.ranks.empty()) mattes.push_back(std::move(matte));
  }
  return mattes;
}

bool LayerFinder::has_colors() const {
  for (size_t i = 0; i < channels_.size(); ++i) {
    if (is_here(i) && role(i) == LayerRole::kColor) return true;
  }
  return false;
}

std::string LayerFinder::listing() const {
  constexpr size_t kShown = 12;
  std::string text;
  size_t count = 0;
  for (size_t i = 0; i < channels_.size(); ++i) {
    if (!is_here(i) && !channels_[i].view.empty()) continue;
    if (count++ < kShown) text += (text.empty() ? "" : ", ") + name_in_file(channels_[i]);
  }
  return count > kShown ? text + " and " + std::to_string(count - kShown) + " more" : text;
}

}  // namespace pelage
