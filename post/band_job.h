// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/job.h"
#include "base/parallel.h"
#include "post/motion_blur.h"
#include "post/view_image.h"

namespace pelage {

/// Result of processing a file.
struct PostReport {
  bool cancelled = false;  ///< nothing was written
  PixelBox window;         ///< box of all pixels that were written
  int steps = 1;
  int bands = 1;                      ///< number of bands in which the file was processed
  float longest = 0;                  ///< max motion or parallax, in pixels
  std::vector<std::string> notes;     ///< for the user, one line each
  std::vector<std::string> warnings;  ///< the same, for probable mistakes
};

/// Parameters that both tools share.
struct PostFileParams {
  LayerChoice layers;
  VectorParams vectors;
  int scale = 4;                      ///< samples per pixel and side, 1 to 8
  std::optional<int> longest_fill;    ///< max number of pixels to fill in a gap; each tool has its default
  int64_t memory = int64_t{4} << 30;  ///< max bytes of pixels, vectors and work buffers
};

/// The file that a tool reads. Throws Error (kInput) when it cannot be read or has no channels.
struct PostSource {
  PostSource(const std::filesystem::path& path, int threads);

  ExrReader reader;
  const std::vector<NamedChannel> channels;
};

/// A view whose pixels move. Without a field, its pixels are copied.
struct MovingView {
  std::unique_ptr<ViewImage> image;
  std::unique_ptr<FlowField> field;
};

/// Processes a file band by band: reads the source rows that a band needs, calls `process` to make the band,
/// and writes it. Uses memory for the fields, `scratch_bytes`, the blocks of rows that the library decodes
/// and encodes, and the rows of a band. A band has the max number of rows that the budget allows.
class BandJob {
 public:
  struct Band {
    int first, last;  ///< rows of the result
  };
  /// Makes the band of one view.
  using Process = std::function<void(const MovingView& view, const WarpTarget& target, Band band,
                                     const PostLayers& layers)>;
  /// Rows of the view's canvas that the band needs.
  using Reach = std::function<RowRange(const MovingView& view, const WarpTarget& target, Band band)>;

  /// A part to write, with a plane number for each channel. Numbers below the channel count of the file are
  /// channels of the file. The following numbers are additional planes that `process` fills.
  struct Part {
    ExrOutputPart part;
    std::vector<size_t> planes;
  };

  /// `source` must outlive this object. `fill`: default of the max number of pixels to fill in a gap.
  BandJob(PostSource& source, const PostFileParams& params, int fill)
      : scale(params.scale),
        longest_fill(params.longest_fill.value_or(fill)),
        memory(params.memory),
        source_(source) {}

  std::vector<MovingView> views;
  std::vector<Part> parts;
  PixelBox window;  ///< window of the result; contains all its parts
  size_t extra_planes = 0;
  const int scale;
  const int longest_fill;  ///< max number of pixels to fill in a gap
  const int64_t memory;
  int64_t scratch_bytes = 0;
  Process process;
  Reach reach;

  /// Plane `extra` of the current band, for `process`.
  Plane extra_plane(size_t extra) const;

  /// Throws Error: kInput and kFailed like reader and writer, kMemory when the budget does not hold the
  /// narrowest band. Sets `cancelled`, `window` and `bands` of the report.
  void run(const std::filesystem::path& output, const Job& job, PostReport& report);

  /// Memory of the views' fields.
  int64_t field_bytes() const;

  /// Position of the view in the window.
  WarpTarget target(const MovingView& view) const;

 private:
  /// Memory except for the bands.
  int64_t fixed_bytes() const;
  int64_t band_bytes(Band band) const;
  Band next_band(int first) const;
  void make_band(Band band);
  void write_band(ExrWriter& writer, Band band, const Workers& workers);
  Plane plane(size_t number, Band band) const;

  PostSource& source_;
  std::vector<float> pixels_, result_;
  Band band_{0, 0};
};

/// Throws Error (kMemory) naming the file when the memory for making the field of this picture and `held`
/// bytes of other fields together exceed the budget.
void check_field_memory(const ViewImage& image, int64_t held, int64_t budget);

/// Throws Error (kInput) naming a layer that was declared as data or colours but is found in no view.
void check_named_layers(const std::vector<MovingView>& views, const LayerChoice& choice);

/// Reads the vectors of a layer, which `params` describes. Reports non-finite vectors and warns of a wrong
/// unit. `flag`: prefix of the flags that set the unit; `where`: end of every message.
std::vector<Flow> read_layer_vectors(const ViewImage& image, std::pair<size_t, size_t> layer,
                                     const VectorParams& params, const std::string& flag,
                                     const std::string& where, PostReport& report);

/// "depth", or "depth 'far'" if it was named.
std::string layer_label(const std::string& what, const std::string& name);

/// Throws Error (kInput); the message names the missing data, the remedy and the available layers.
[[noreturn]] void fail_missing(const ViewImage& image, const std::string& what, const std::string& advice);

}  // namespace pelage
