/* SPDX-License-Identifier: Apache-2.0 */
/* What a host written in C does: interleaved RGBA, vectors and depth apart. */
#include <string.h>

#include "post/pelage_post.h"

static int stop_at_once(void* user, double done) {
  *(double*)user = done;
  return 1;
}

static pelage_post_plane plane(const float* words, ptrdiff_t pixel, ptrdiff_t row) {
  pelage_post_plane result;
  result.words = words;
  result.pixel_stride = pixel;
  result.row_stride = row;
  return result;
}

/* Moves `rgba` (width * height * 4) by whole vectors, or to the other eye; returns the result's code. */
int host_run(int stereo, int width, int height, const float* rgba, const float* depth, const float* motion_x,
             const float* motion_y, float* out, char message[160]) {
  pelage_post_channel channels[4];
  pelage_post_image image;
  pelage_post_options options;
  pelage_post_result result;
  int c;
  for (c = 0; c < 4; ++c) {
    channels[c].role = PELAGE_POST_COLOR;
    channels[c].source = plane(rgba + c, 4, 4 * (ptrdiff_t)width);
    channels[c].target = out + c;
    channels[c].target_pixel_stride = 4;
    channels[c].target_row_stride = 4 * (ptrdiff_t)width;
  }
  memset(&image, 0, sizeof image);
  image.size = sizeof image;
  image.width = width;
  image.height = height;
  image.channels = channels;
  image.channel_count = 4;
  image.depth = plane(depth, 1, width);
  image.alpha = plane(rgba + 3, 4, 4 * (ptrdiff_t)width);
  image.motion_x = plane(motion_x, 1, width);
  image.motion_y = plane(motion_y, 1, width);
  pelage_post_defaults(&options);
  options.threads = 2;
  if (stereo) {
    options.focal_pixels = 100;
    options.eye_separation = 0.5f;
    options.convergence = 10;
    options.scale = 6;
    options.box_filter = 1;
    result = pelage_stereo(&image, &options);
  } else {
    options.shutter = 0;
    options.centre = 1;
    options.steps = 1;
    result = pelage_motion_blur(&image, &options);
  }
  memcpy(message, options.message, sizeof options.message);
  return (int)result;
}

/* The code when the progress function stops the work; `seen` gets the part that was done. */
int host_stop(const float* four_pixels, float* out, double* seen) {
  pelage_post_channel channel;
  pelage_post_image image;
  pelage_post_options options;
  channel.role = PELAGE_POST_COLOR;
  channel.source = plane(four_pixels, 1, 2);
  channel.target = out;
  channel.target_pixel_stride = 1;
  channel.target_row_stride = 2;
  memset(&image, 0, sizeof image);
  image.size = sizeof image;
  image.width = image.height = 2;
  image.channels = &channel;
  image.channel_count = 1;
  image.motion_x = image.motion_y = plane(four_pixels, 1, 2);
  pelage_post_defaults(&options);
  options.progress = stop_at_once;
  options.user = seen;
  return (int)pelage_motion_blur(&image, &options);
}
