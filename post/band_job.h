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
  bool cancelled = false;             ///< true: the job was cancelled and no file was written
  PixelBox window;                    ///< box that contains all pixels written
  int steps = 1;                      ///< number of times at which the picture was sampled
  int bands = 1;                      ///< number of bands in which the file was processed
  float longest = 0;                  ///< length of the longest motion or parallax, in pixels
  uint64_t depth_hash = 0;            ///< of motion blur: hash of the depths of all views
  std::vector<std::string> notes;     ///< information for the user, one line each
  std::vector<std::string> warnings;  ///< probable mistakes of the user, one line each
};

/// Parameters that the tools for motion blur and stereo share.
struct PostFileParams {
  LayerChoice layers;
  VectorParams vectors;
  int scale = 4;                      ///< samples along each side of a pixel, 1 to 8
  std::optional<int> longest_fill;    ///< max number of pixels to fill in each gap; empty: the tool's default
  int64_t memory = int64_t{4} << 30;  ///< max memory of pixels, vectors and work buffers, in bytes
};

/// The input file of a tool.
struct PostSource {
  /// Throws Error (kInput) when the file cannot be read or has no channels.
  PostSource(const std::filesystem::path& path, int threads);

  ExrReader reader;
  const std::vector<NamedChannel> channels;
};

/// A view of the file. Its pixels move as `field` describes; if `field` is null, they are copied.
struct MovingView {
  std::unique_ptr<ViewImage> image;
  std::unique_ptr<FlowField> field;
};

/// Processes a file in bands of rows of the result. For each band, reads the source rows that the band needs,
/// calls `process` to make the rows of the band, and writes these rows. The memory in use is the sum of the
/// fields, `scratch_bytes`, the blocks of rows that OpenEXR decodes and encodes, and the source rows and
/// result rows of a band. A band has as many rows as `memory` allows, but takes at most 256 MiB unless it has
/// 16 rows or fewer.
class BandJob {
 public:
  struct Band {
    int first, last;  ///< rows first <= y < last of the result
  };
  /// Makes the rows of one band for one view. `layers` has the source rows and the result rows.
  using Process = std::function<void(const MovingView& view, const WarpTarget& target, Band band,
                                     const PostLayers& layers)>;
  /// Returns the rows of the view's canvas that a band needs.
  using Reach = std::function<RowRange(const MovingView& view, const WarpTarget& target, Band band)>;

  /// A part to write. `planes` has one number for each channel of the part. Numbers below the count of
  /// channels in PostSource::channels are indices of these channels. The numbers that follow are additional
  /// planes, which `process` fills (extra_plane()).
  struct Part {
    ExrOutputPart part;
    std::vector<size_t> planes;
  };

  /// `source` must outlive this object. `fill`: value of `longest_fill` if `params` does not set it.
  BandJob(PostSource& source, const PostFileParams& params, int fill)
      : scale(params.scale),
        longest_fill(params.longest_fill.value_or(fill)),
        memory(params.memory),
        source_(source) {}

  std::vector<MovingView> views;
  std::vector<Part> parts;
  PixelBox window;            ///< pixels of the result; contains the data windows of all `parts`
  size_t extra_planes = 0;    ///< count of additional planes, see Part
  const int scale;            ///< samples along each side of a pixel
  const int longest_fill;     ///< max number of pixels to fill in each gap
  const int64_t memory;       ///< max memory in bytes
  int64_t scratch_bytes = 0;  ///< memory that `process` uses on all threads, in bytes
  Process process;
  Reach reach;

  /// Returns additional plane `extra` (from 0) of the current band. Only `process` may call it.
  Plane extra_plane(size_t extra) const;

  /// Makes and writes all bands. Sets `cancelled`, `window` and `bands` of the report. Passes on the errors
  /// of ExrReader and ExrWriter. Throws Error (kMemory) when `memory` does not suffice for a band of 16 rows.
  void run(const std::filesystem::path& output, const Job& job, PostReport& report);

  /// Memory of the fields of all views, in bytes.
  int64_t field_bytes() const;

  /// Returns the position of `window` in the canvas of the view, with the scale and the max width of seams.
  WarpTarget target(const MovingView& view) const;

 private:
  /// Memory in bytes that does not depend on the size of a band.
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

/// Throws Error (kMemory) naming the file when making the field of this picture, together with `held` bytes
/// of other fields, needs more than `budget` bytes.
void check_field_memory(const ViewImage& image, int64_t held, int64_t budget);

/// Throws Error (kInput) naming the layer when `choice` declares a layer as data or colours that no view has.
void check_named_layers(const std::vector<MovingView>& views, const LayerChoice& choice);

/// Reads vectors from two channels, u and v (`layer`: their indices), and converts them to pixels as `params`
/// describes. Adds a note about non-finite vectors, and a warning if the unit seems wrong. `flag`: prefix of
/// the command line options that set the unit, such as "--motion". `where`: text appended to both messages.
std::vector<Flow> read_layer_vectors(const ViewImage& image, std::pair<size_t, size_t> layer,
                                     const VectorParams& params, const std::string& flag,
                                     const std::string& where, PostReport& report);

/// Returns a layer's description for messages: "depth", or "depth 'far'" if `name` is "far" instead of empty.
std::string layer_label(const std::string& what, const std::string& name);

/// Throws Error (kInput). The message states that `what` is missing, gives `advice`, and lists the available
/// channels.
[[noreturn]] void fail_missing(const ViewImage& image, const std::string& what, const std::string& advice);

}  // namespace pelage
