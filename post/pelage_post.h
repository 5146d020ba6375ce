/* SPDX-License-Identifier: Apache-2.0 */
#ifndef PELAGE_POST_H
#define PELAGE_POST_H
#pragma once
/*
 * C interface for compositing programs (hosts): adds motion blur to a picture, or makes the picture of the
 * second eye from the picture of the first eye. All pictures are in memory of the host.
 *
 * Describe the picture in a pelage_post_image, fill a pelage_post_options with pelage_post_defaults(), change
 * options as needed, and call pelage_motion_blur() or pelage_stereo(). The functions keep no state between
 * calls, throw no exceptions, and may run concurrently. pelage_post_image and pelage_post_options start with
 * their size, so that later versions can extend them.
 *
 * Rows of pixels run from the top; x points right, y points down. Each channel may be anywhere in memory; its
 * strides are in floats. Result and source have the same size. Targets must not overlap memory that is read.
 * Motion vectors are in pixels per frame. Depth is the distance along the camera axis. Pixels with alpha 0
 * count as infinitely far away, whatever their depth.
 */
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define PELAGE_POST_API __attribute__((visibility("default")))
#else
#define PELAGE_POST_API
#endif

typedef enum pelage_post_result {
  PELAGE_POST_DONE = 0,
  PELAGE_POST_CANCELLED = 1,    /* the progress function asked to stop; targets are unfinished */
  PELAGE_POST_BAD_ARGUMENT = 2, /* pelage_post_options.message describes the problem */
  PELAGE_POST_NO_MEMORY = 3
} pelage_post_result;

typedef enum pelage_post_role {
  PELAGE_POST_COLOR = 0, /* premultiplied light or coverage: the average */
  PELAGE_POST_DATA = 1,  /* the value of the nearest visible pixel; zero if there is none */
  PELAGE_POST_DEPTH = 2  /* the value of the nearest visible pixel; infinity if there is none */
} pelage_post_role;

/* Read-only floats: pixel (x, y) is words[y * row_stride + x * pixel_stride]. */
typedef struct pelage_post_plane {
  const float* words;
  ptrdiff_t pixel_stride;
  ptrdiff_t row_stride;
} pelage_post_plane;

typedef struct pelage_post_channel {
  pelage_post_role role;
  pelage_post_plane source;
  float* target; /* pixel (0, 0) of the result */
  ptrdiff_t target_pixel_stride;
  ptrdiff_t target_row_stride;
} pelage_post_channel;

typedef struct pelage_post_image {
  size_t size;       /* sizeof(pelage_post_image) */
  int width, height; /* at most 65535 */
  const pelage_post_channel* channels;
  size_t channel_count;
  pelage_post_plane depth;              /* required for stereo; else words NULL: same depth everywhere */
  pelage_post_plane alpha;              /* words NULL: alpha is 1 everywhere */
  pelage_post_plane motion_x, motion_y; /* required for motion blur; unused for stereo */
} pelage_post_image;

/* Called from any thread with the fraction of the work that is done, 0 to 1. Return 0 to continue, any other
 * value to stop. */
typedef int (*pelage_post_progress)(void* user, double done);

typedef struct pelage_post_options {
  size_t size;          /* sizeof(pelage_post_options) */
  int scale;            /* samples along each side of a pixel, 1 to 8 */
  int threads;          /* number of threads; 0: one per processor */
  float shutter;        /* motion blur: time for which the shutter is open, in frames */
  float centre;         /* motion blur: middle of this time, in frames from the rendered instant */
  int steps;            /* motion blur: number of sample times, up to 4096; 0: one per pixel of the
                           longest motion, but 8 to 64 */
  float focal_pixels;   /* stereo: focal length, in pixels of the picture's width */
  float eye_separation; /* stereo: scene units to the other eye; positive: right, negative: left */
  float convergence;    /* stereo: distance with zero parallax, in scene units; may be infinite */
  int box_filter;       /* stereo: 0: Lanczos filter, else box filter */
  int longest_fill;     /* max number of pixels to fill in each gap, up to 65535; -1: 65535 for stereo,
                           4 for motion blur */
  float* invented;      /* stereo: NULL, or width * height floats that receive the filled fraction of
                           each pixel */
  pelage_post_progress progress; /* NULL: none */
  void* user;
  char message[160]; /* result: describes a bad argument; else empty */
} pelage_post_options;

/* Sets `size`, and all other members to their defaults. */
PELAGE_POST_API void pelage_post_defaults(pelage_post_options* options);

PELAGE_POST_API pelage_post_result pelage_motion_blur(const pelage_post_image* image,
                                                      pelage_post_options* options);
PELAGE_POST_API pelage_post_result pelage_stereo(const pelage_post_image* image,
                                                 pelage_post_options* options);

#ifdef __cplusplus
}
#endif
#endif
