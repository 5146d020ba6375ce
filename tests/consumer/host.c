/* SPDX-License-Identifier: Apache-2.0 */
/* A host written in C: a white bar in a row of pixels, blurred by its motion, and seen by the other eye. */
#include <stdio.h>
#include <string.h>

#include "post/pelage_post.h"

enum { kWidth = 12 };

static pelage_post_plane row(const float* words) {
  const pelage_post_plane plane = {words, 1, kWidth};
  return plane;
}

static void print(const char* what, const float* pixels) {
  printf("%s:", what);
  for (int x = 0; x < kWidth; ++x) printf(" %g", pixels[x]);
  printf("\n");
}

int main(void) {
  float light[kWidth] = {0}, depth[kWidth], motion_x[kWidth], motion_y[kWidth] = {0}, result[kWidth] = {0};
  for (int x = 0; x < kWidth; ++x) {
    if (x == 6 || x == 7) light[x] = 1;
    depth[x] = 5;
    motion_x[x] = 4;
  }

  pelage_post_channel channel;
  memset(&channel, 0, sizeof channel);
  channel.role = PELAGE_POST_COLOR;
  channel.source = row(light);
  channel.target = result;
  channel.target_pixel_stride = 1;
  channel.target_row_stride = kWidth;

  pelage_post_image image;
  memset(&image, 0, sizeof image);
  image.size = sizeof image;
  image.width = kWidth;
  image.height = 1;
  image.channels = &channel;
  image.channel_count = 1;
  image.depth = row(depth);
  image.motion_x = row(motion_x);
  image.motion_y = row(motion_y);

  pelage_post_options options;
  pelage_post_defaults(&options);
  options.steps = 2; /* a quarter of a frame earlier and later: a pixel each way */
  options.shutter = 1;
  if (pelage_motion_blur(&image, &options) != PELAGE_POST_DONE) return 1;
  print("blurred", result);

  options.focal_pixels = 20;
  options.eye_separation = 1; /* 20 * 1 / 5: four pixels to the left */
  options.box_filter = 1;
  if (pelage_stereo(&image, &options) != PELAGE_POST_DONE) return 1;
  print("other eye", result);

  options.scale = 9;
  if (pelage_stereo(&image, &options) != PELAGE_POST_BAD_ARGUMENT) return 1;
  printf("%s\n", options.message);
  return 0;
}
