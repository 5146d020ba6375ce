// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "post/flow_field.h"
#include "post/layer_names.h"
#include "post/vector_survey.h"

namespace pelage {

/// One view of a file, whose parts are placed on one canvas. The canvas is the smallest window that contains
/// the data windows of all parts of the view. Finds the layers of the view and reads their pixels, but stores
/// no pixels.
class ViewImage {
 public:
  /// `channels`: all channels of the file. Throws Error (kInput) when the canvas is wider or higher than
  /// FlowField::kLargestSide.
  ViewImage(ExrReader& reader, const std::vector<NamedChannel>& channels, const std::string& view,
            const LayerChoice& choice);

  const LayerFinder& layers() const { return layers_; }
  /// The canvas, in the pixel space of the file. In all other members, pixel (0, 0) is its upper left corner.
  const PixelBox& canvas() const { return canvas_; }
  /// Smallest box that contains the display windows and data windows of all parts, in the pixel space of the
  /// file.
  const PixelBox& limits() const { return limits_; }
  /// Returns the max distance in pixels by which motion may move a pixel outside the canvas. This is the
  /// diagonal of limits(), but at most kUsualReach or the diagonal of the canvas, whichever is larger. Thus
  /// the size of the source pixels bounds the size of the result.
  int largest_reach() const;
  static constexpr int kUsualReach = 1024;
  const std::vector<NamedChannel>& channels() const { return channels_; }
  /// Indices of the channels of this view.
  const std::vector<size_t>& own() const { return own_; }
  ExrReader& reader() const { return reader_; }

  /// Reads rows first <= y < last of some channels (indices of channels()) into `words`: all rows of the
  /// first channel, then all rows of the next one. Pixels outside the data window of a part are zero.
  void read(const std::vector<size_t>& channels, int first, int last, std::vector<float>& words) const;

  /// Returns the depth of all pixels of the canvas: infinity where alpha is 0, otherwise the value of the
  /// channel `depth`, or 1 if `depth` is empty. If `alpha` is empty, no pixel has alpha 0. `edges` receives
  /// edge_bits() of every pixel.
  std::vector<float> read_depth(std::optional<size_t> depth, std::optional<size_t> alpha,
                                std::vector<uint8_t>& edges) const;
  /// Returns the vectors of all pixels of the canvas, converted to pixels. Adds them to `survey`. `uv`:
  /// indices of the channels u and v.
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
