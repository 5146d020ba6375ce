// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "post/flow_field.h"
#include "post/layer_names.h"
#include "post/vector_survey.h"

namespace pelage {

/// One view of a file on one canvas: the smallest window that holds all its parts. Knows where everything is,
/// and reads it; keeps no pixels.
class ViewImage {
 public:
  /// `channels` are those of the file; Throws Error (kInput) when the parts lie too far apart for one
  /// picture.
  ViewImage(ExrReader& reader, const std::vector<NamedChannel>& channels, const std::string& view,
            const LayerChoice& choice);

  const LayerFinder& layers() const { return layers_; }
  /// In the pixel space of the file; coordinates of the canvas begin at its upper left corner.
  const PixelBox& canvas() const { return canvas_; }
  /// Where the parts' frames and pixels are.
  const PixelBox& limits() const { return limits_; }
  /// Pixels that motion may carry something beyond the canvas: the diagonal of the frame. Of a few pixels in
  /// a frame that is far larger, the larger one of their own diagonal and kUsualReach, so that the size of
  /// the result is bounded by that of the source.
  int largest_reach() const;
  static constexpr int kUsualReach = 1024;
  const std::vector<NamedChannel>& channels() const { return channels_; }
  /// Numbers of the channels of this view.
  const std::vector<size_t>& own() const { return own_; }
  ExrReader& reader() const { return reader_; }

  /// Rows first <= y < last of the canvas, of some channels one after the other, each rows * width words;
  /// zero where a part has no pixels.
  void read(const std::vector<size_t>& channels, int first, int last, std::vector<float>& words) const;

  /// Depth for all of the canvas: infinite where alpha is zero; `depth` empty: 1 wherever there is alpha.
  /// `edges` gets the bits of post/soft_edges.h.
  std::vector<float> read_depth(std::optional<size_t> depth, std::optional<size_t> alpha,
                                std::vector<uint8_t>& edges) const;
  /// Vectors for all of the canvas, counted by `survey`.
  std::vector<Flow> read_vectors(std::pair<size_t, size_t> uv, const VectorParams& params,
                                 VectorSurvey& survey) const;

 private:
  void read_into(const std::vector<size_t>& channels, int first, int last, float* words) const;

  ExrReader& reader_;
  const std::vector<NamedChannel>& channels_;
  LayerFinder layers_;
  std::vector<size_t> own_;
  PixelBox canvas_, limits_;
};

}  // namespace pelage
