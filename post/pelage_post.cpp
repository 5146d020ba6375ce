// SPDX-License-Identifier: Apache-2.0
#include "post/pelage_post.h"

#include <atomic>
#include <cmath>
#include <cstring>
#include <new>

#include "post/motion_blur.h"
#include "post/soft_edges.h"
#include "post/stereo.h"

namespace pelage {
namespace {

/// A mistake of the caller; never leaves this file.
struct BadArgument {
  const char* message;
};

void require(bool condition, const char* message) {
  if (!condition) throw BadArgument{message};
}

class HostProgress final : public Progress {
 public:
  HostProgress(const pelage_post_options& options, double total) : options_(options), total_(total) {}
  void begin(std::string_view, double) override {}
  void advance(double amount) override {
    const double done = done_.fetch_add(amount) + amount;
    if (options_.progress && options_.progress(options_.user, std::min(1.0, done / total_)) != 0)
      stop_ = true;
  }
  void end() override {}
  bool cancelled() const override { return stop_; }

 private:
  const pelage_post_options& options_;
  double total_;
  std::atomic<double> done_{0};
  std::atomic<bool> stop_{false};
};

float value(const pelage_post_plane& plane, int x, int y) {
  return plane.words[y * plane.row_stride + x * plane.pixel_stride];
}

void check(const pelage_post_image* image, const pelage_post_options& options) {
  require(image != nullptr && image->size == sizeof(pelage_post_image), "image: wrong size");
  require(options.size == sizeof(pelage_post_options), "options: wrong size");
  require(image->width > 0 && image->height > 0 && image->width <= FlowField::kLargestSide &&
              image->height <= FlowField::kLargestSide,
          "image: width and height must be 1 to 65535");
  require(options.scale >= 1 && options.scale <= 8, "scale must be 1 to 8");
  require(options.longest_fill >= -1 && options.longest_fill <= FlowField::kLargestSide,
          "longest_fill must be -1 to 65535");
  require(options.threads >= 0 && options.threads <= 4096, "threads must be 0 to 4096");
  require(image->channel_count == 0 || image->channels != nullptr, "image: channels are missing");
  for (size_t i = 0; i < image->channel_count; ++i) {
    const pelage_post_channel& c = image->channels[i];
    require(c.source.words && c.target, "a channel lacks a source or a target");
    require(c.role >= PELAGE_POST_COLOR && c.role <= PELAGE_POST_DEPTH, "a channel has an unknown role");
  }
}

PostLayers layers_of(const pelage_post_image& image) {
  PostLayers layers;
  for (size_t i = 0; i < image.channel_count; ++i) {
    const pelage_post_channel& c = image.channels[i];
    const LayerRole roles[] = {LayerRole::kColor, LayerRole::kData, LayerRole::kDepth};
    // Sources are read-only, which Plane does not express.
    layers.channels.push_back(
        {roles[c.role],
         {const_cast<float*>(c.source.words), c.source.pixel_stride, c.source.row_stride, 0},
         {c.target, c.target_pixel_stride, c.target_row_stride, 0}});
  }
  return layers;
}

/// Depth of every pixel; soft edges get the depth of their surfaces, and their vectors if there are any.
std::vector<float> depth_of(const pelage_post_image& image, std::vector<Flow>& motion,
                            std::vector<uint8_t>& edges) {
  std::vector<float> depth;
  depth.reserve(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  edges.reserve(depth.capacity());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const bool is_clear = image.alpha.words && value(image.alpha, x, y) == 0;
      depth.push_back(is_clear            ? std::numeric_limits<float>::infinity()
                      : image.depth.words ? value(image.depth, x, y)
                                          : 1);
      edges.push_back(image.alpha.words ? edge_bits(value(image.alpha, x, y), depth.back()) : uint8_t{0});
    }
  }
  join_soft_edges(image.width, image.height, edges, depth, motion);
  return depth;
}

void blur(const pelage_post_image& image, const pelage_post_options& options, Progress& progress) {
  require(image.motion_x.words && image.motion_y.words, "image: motion is missing");
  require(std::isfinite(options.shutter) && std::isfinite(options.centre), "the shutter is not finite");
  require(options.steps >= 0 && options.steps <= 4096, "steps must be 0 to 4096");
  const Workers workers(options.threads);
  std::vector<Flow> motion;
  motion.reserve(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  float longest = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      motion.push_back({value(image.motion_x, x, y), value(image.motion_y, x, y)});
      const float length = std::hypot(motion.back().x, motion.back().y);
      if (std::isfinite(length)) longest = std::max(longest, length);
    }
  }
  LinkLimits limits;
  limits.largest_time = std::abs(options.centre) + std::abs(options.shutter) / 2;
  std::vector<uint8_t> edges;
  std::vector<float> depth = depth_of(image, motion, edges);
  const FlowField field(image.width, image.height, std::move(motion), std::move(depth), limits, workers);
  const BlurJob job{&field,
                    {options.scale, 0, 0,
                     static_cast<float>(options.longest_fill < 0 ? kDefaultSeam : options.longest_fill)},
                    shutter_times({options.shutter, options.centre, options.steps}, longest),
                    image.width,
                    0,
                    image.height};
  blur_rows(job, layers_of(image), PostTiling(), workers, progress);
}

void other_eye(const pelage_post_image& image, const pelage_post_options& options, Progress& progress) {
  require(image.depth.words != nullptr, "image: depth is missing");
  require(std::isfinite(options.focal_pixels) && options.focal_pixels > 0, "focal_pixels must be above 0");
  require(std::isfinite(options.eye_separation), "eye_separation is not finite");
  require(options.convergence > 0, "convergence must be above 0");
  const Workers workers(options.threads);
  const StereoCamera camera{options.focal_pixels, options.eye_separation, options.convergence};
  std::vector<Flow> motion;
  std::vector<uint8_t> edges;
  std::vector<float> depth = depth_of(image, motion, edges);
  motion = parallax_field(depth, camera);
  const FlowField field(image.width, image.height, std::move(motion), std::move(depth), LinkLimits(), workers,
                        &edges);
  StereoJob job;
  job.field = &field;
  job.target.scale = options.scale;
  job.filter = options.box_filter ? StereoFilter::kBox : StereoFilter::kLanczos;
  job.longest_fill = options.longest_fill < 0 ? kFillEverything : options.longest_fill;
  job.width = image.width;
  job.height = job.last_row = image.height;
  if (options.invented) job.invented = Plane{options.invented, 1, image.width, 0};
  stereo_rows(job, layers_of(image), kStripRows, workers, progress);
}

template <class Work>
pelage_post_result guarded(const pelage_post_image* image, pelage_post_options* options, Work&& work) {
  if (options == nullptr) return PELAGE_POST_BAD_ARGUMENT;
  try {
    check(image, *options);
    options->message[0] = '\0';
    HostProgress progress(*options, image->height);
    work(*image, *options, progress);
    return progress.cancelled() ? PELAGE_POST_CANCELLED : PELAGE_POST_DONE;
  } catch (const BadArgument& bad) {
    if (options->size == sizeof(pelage_post_options)) {
      std::strncpy(options->message, bad.message, sizeof options->message - 1);
      options->message[sizeof options->message - 1] = '\0';
    }
    return PELAGE_POST_BAD_ARGUMENT;
  } catch (...) {  // only allocations throw anything else
    return PELAGE_POST_NO_MEMORY;
  }
}

}  // namespace
}  // namespace pelage

extern "C" {

void pelage_post_defaults(pelage_post_options* options) {
  std::memset(options, 0, sizeof *options);
  options->size = sizeof *options;
  options->scale = 4;
  options->shutter = 0.5f;
  options->convergence = std::numeric_limits<float>::infinity();
  options->longest_fill = -1;
}

pelage_post_result pelage_motion_blur(const pelage_post_image* image, pelage_post_options* options) {
  return pelage::guarded(image, options, pelage::blur);
}

pelage_post_result pelage_stereo(const pelage_post_image* image, pelage_post_options* options) {
  return pelage::guarded(image, options, pelage::other_eye);
}
}
