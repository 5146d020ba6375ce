// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "image/exr_file.h"
#include "post/layers.h"

namespace pelage {

/// A channel of a file and the meaning of its name. If a layer is stored in a separate part, its channel
/// names often contain no layer; the name of the part is then the layer.
struct NamedChannel {
  size_t part = 0, channel = 0;  ///< indices in ExrReader::parts() and in the part
  std::string view;              ///< empty when the file has no views, or the channel belongs to none
  std::string layer;             ///< "key.diffuse" of "key.diffuse.R"; empty for a bare name
  std::string component;         ///< "R"
  ChannelType type = ChannelType::kHalf;
  /// The name without its view.
  std::string name() const { return layer.empty() ? component : layer + "." + component; }
};

/// All channels of a file, in order, with the views of multi-view files removed from their names: from the
/// part's `view`, or from "left.R" and "forward.left.u" where the header lists the views.
std::vector<NamedChannel> name_channels(const std::vector<ExrPart>& parts);

/// Names of the views, the default one first; {""} for a file without views.
std::vector<std::string> views_of(const std::vector<NamedChannel>& channels,
                                  const std::vector<ExrPart>& parts);

/// User's choice of layers whose names are not standard.
struct LayerChoice {
  std::string motion;             ///< "forward", a part's name, or two channels: "mv.R,mv.G"
  std::string depth;              ///< a layer, a part or a channel; "none": everything has the same distance
  std::vector<std::string> data;  ///< layers that are not averaged
  std::vector<std::string> colors;  ///< layers that are averaged, whatever their names suggest
};

/// Finds the layers that the tools need among the channels of one view. Names are compared ignoring case and
/// punctuation. Numbers are indices of `channels`.
class LayerFinder {
 public:
  LayerFinder(const std::vector<NamedChannel>& channels, const std::vector<ExrPart>& parts, std::string view,
              const LayerChoice& choice);

  /// Both channels of the vectors: u and v, x and y, or r and g of the chosen layer, otherwise of "forward",
  /// "motion" and other usual names.
  std::optional<std::pair<size_t, size_t>> motion() const { return motion_; }
  /// The same for a layer with this name. Falls back to channels that belong to no view.
  std::optional<std::pair<size_t, size_t>> vectors(const std::string& name) const;
  std::optional<size_t> depth() const { return depth_; }
  /// The alpha channel without a layer, or else of a layer "combined", "beauty" or "rgba".
  std::optional<size_t> alpha() const;
  LayerRole role(size_t channel) const;
  /// Cryptomattes declared by the attributes, as indices of channels.
  const std::vector<RankedMatte>& mattes() const { return mattes_; }
  bool has_colors() const;
  /// Whether any channel of the file has this name as channel, layer or part.
  bool has(const std::string& name) const;

  /// The available channels, for messages: "R, G, B, A, key.diffuse.R and 12 more". With several parts, names
  /// without a layer follow the name of their part: "mv.R".
  std::string listing() const;

 private:
  bool is_here(size_t channel) const { return channels_[channel].view == view_; }
  /// Calls `search` for this view and, if that finds nothing, for channels that belong to no view.
  template <class Search>
  auto in_view_or_none(Search&& search) const {
    const auto found = search(view_);
    return found || view_.empty() ? found : search(std::string());
  }
  std::optional<std::pair<size_t, size_t>> vectors_in(const std::string& view, const std::string& name) const;
  std::optional<size_t> bare_alpha() const;
  std::optional<size_t> depth_in(const std::string& view) const;
  bool is_called(const NamedChannel& channel, const std::string& plain_layer) const;
  bool is_listed(const NamedChannel& channel, const std::vector<std::string>& names) const;
  std::string name_in_file(const NamedChannel& channel) const;
  std::optional<size_t> find_channel(const std::string& view, const std::string& name) const;
  std::optional<std::pair<size_t, size_t>> find_motion() const;
  std::optional<size_t> find_depth() const;
  std::vector<RankedMatte> find_mattes() const;
  std::optional<size_t> find(const std::string& view, const std::string& plain_layer,
                             const std::vector<std::string>& components) const;

  const std::vector<NamedChannel>& channels_;
  const std::vector<ExrPart>& parts_;
  std::string view_;
  const LayerChoice& choice_;
  std::optional<std::pair<size_t, size_t>> motion_;
  std::optional<size_t> depth_;
  std::vector<RankedMatte> mattes_;
  std::set<size_t> ranked_;  // channels of mattes_
};

}  // namespace pelage
