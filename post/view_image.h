// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "post/flow_field.h"
#include "post/layer_names.h"
#include "post/vector_survey.h"

namespace pelage {

/// One view of a file on one canvas: the smallest window that contains all its parts. Locates and reads the
/// data; stores no pixels.
class ViewImage {
 public:
  /// `channels`: all channels of the file. Throws Error (kInput) when the parts are too far apart for one
  /// picture.
  ViewImage(ExrReader& reader, const std::vector<NamedChannel>& channels, const std::string& view,
            const LayerChoice& choice);

  const LayerFinder& layers() const { return layers_; }
  /// In the pixel space of the file; coordinates of the canvas start at its upper left corner.
  const PixelBox& canvas() const { return canvas_; }
  /// Bounds of the parts' frames and pixels.
  const PixelBox& limits() const { return limits_; }
  /// Max distance in pixels by which motion may move a pixel outside the canvas: the diagonal of the frame.
  /// If the frame is far larger than the canvas, it is the max of the canvas's diagonal and kUsualReach, so
  /// that the size of the source bounds the size of the result.
  int largest_reach() const;
  static constexpr int kUsualReach = 1024;
  const std::vector<NamedChannel>& channels() const { return channels_; }
  /// Indices of the channels of this view.
  const std::vector<size_t>& own() const { return own_; }
  ExrReader& reader() const { return reader_; }

  /// Reads rows first <= y < last of the canvas. Stores the given channels one after the other, rows * width
  /// words each, with zeros where a part has no pixels.
  void read(const std::vector<size_t>& channels, int first, int last, std::vector<float>& words) const;

  /// Depth for the whole canvas, infinite where alpha is zero. Without `depth`, it is 1 wherever alpha is not
  /// zero. `edges` receives the bits of post/soft_edges.h.
  std::vector<float> read_depth(std::optional<size_t> depth, std::optional<size_t> alpha,
                                std::vector<uint8_t>& edges) const;
  /// Vectors for the whole canvas, also added to `survey`.
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
