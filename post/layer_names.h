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

/// A channel of a file, with its name split into view, layer and component. If a layer is stored in a part of
/// its own, the names of its channels often contain no layer; then the name of the part is the name of the
/// layer.
struct NamedChannel {
  size_t part = 0, channel = 0;  ///< index in ExrReader::parts(), and in ExrPart::channels
  std::string view;              ///< empty if the channel belongs to no view
  std::string layer;             ///< "key.diffuse" of "key.diffuse.R"; empty for "R"
  std::string component;         ///< "R" of "key.diffuse.R"
  ChannelType type = ChannelType::kHalf;
  /// Returns the name without the view.
  std::string name() const { return layer.empty() ? component : layer + "." + component; }
};

/// Returns all channels of a file, in order, and determines their views. If a part has a `view`, all its
/// channels belong to this view. If the header lists several views instead (ExrPart::multi_view), the view is
/// the second last of the names between dots: "left" in "left.R" and in "forward.left.u". A name without a
/// dot, such as "R", belongs to the default view.
std::vector<NamedChannel> name_channels(const std::vector<ExrPart>& parts);

/// Returns the names of the views, with the default view first. Contains "" if some channels belong to no
/// view.
std::vector<std::string> views_of(const std::vector<NamedChannel>& channels,
                                  const std::vector<ExrPart>& parts);

/// Layers that the user chose, because their names are not standard. Empty members mean no choice.
struct LayerChoice {
  std::string motion;               ///< a layer, a part, or two channels: "mv.R,mv.G"
  std::string depth;                ///< a layer, a part or a channel; "none": all pixels have the same depth
  std::vector<std::string> data;    ///< layers, parts or channels that are not averaged
  std::vector<std::string> colors;  ///< layers, parts or channels that are averaged, also if named like data
};

/// Finds the layers that the tools need among the channels of one view. Comparisons of names ignore case and
/// punctuation. All size_t values are indices of `channels`.
class LayerFinder {
 public:
  LayerFinder(const std::vector<NamedChannel>& channels, const std::vector<ExrPart>& parts, std::string view,
              const LayerChoice& choice);

  /// Returns the two channels of the motion vectors; empty if there are none. They are called u and v, x and
  /// y, r and g, or red and green. Their layer is the one that the user chose or, without a choice, the first
  /// of "forward", "motion" and other usual names.
  std::optional<std::pair<size_t, size_t>> motion() const { return motion_; }
  /// Returns the two channels of the vectors in the layer `name` of this view or, if there is none, among
  /// channels that belong to no view. `name` may also be two channels: "mv.R,mv.G".
  std::optional<std::pair<size_t, size_t>> vectors(const std::string& name) const;
  /// Returns the channel of the depth: the user's choice, or a channel with a usual name; empty if there is
  /// none.
  std::optional<size_t> depth() const { return depth_; }
  /// Returns the alpha channel that belongs to no layer or, if there is none, the alpha channel of a layer
  /// "combined", "beauty" or "rgba".
  std::optional<size_t> alpha() const;
  LayerRole role(size_t channel) const;
  /// Returns the Cryptomattes that the attributes of the file declare.
  const std::vector<RankedMatte>& mattes() const { return mattes_; }
  /// Whether any channel of this view has the role kColor.
  bool has_colors() const;
  /// Whether this is the name of a channel, layer or part of the file, in any view.
  bool has(const std::string& name) const;

  /// Returns the names of the first 12 channels, for messages: "R, G, B, A, key.diffuse.R and 12 more". If
  /// the file has several parts, the name of a channel without a layer is preceded by the name of its part:
  /// "mv.R".
  std::string listing() const;

 private:
  bool is_here(size_t channel) const { return channels_[channel].view == view_; }
  /// Calls search(view) with this view. If `search` finds nothing, calls it with "", for channels of no view.
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
