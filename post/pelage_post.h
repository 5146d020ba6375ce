/* SPDX-License-Identifier: Apache-2.0 */
#ifndef PELAGE_POST_H
#define PELAGE_POST_H
#pragma once
/*
 * Motion blur and stereo from one eye, for a compositing host: plain C, pictures in the host's own memory.
 *
 * Fill a pelage_post_image with the picture, an options struct with its *_defaults function, call
 * pelage_motion_blur or pelage_stereo. The functions keep no state between calls, throw no exceptions, and
 * may run concurrently. Every struct starts with its size, so that later versions can extend it.
 *
 * Pixels: rows from the top, x right, y down; channels anywhere in memory, with strides in floats. Result and
 * source have the same size; targets must not overlap memory that is read. Vectors are in pixels per frame,
 * depth is the distance along the camera axis; pixels with alpha 0 are infinitely far away.
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
  PELAGE_POST_BAD_ARGUMENT = 2, /* described in pelage_post_options.message */
  PELAGE_POST_NO_MEMORY = 3
} pelage_post_result;

typedef enum pelage_post_role {
  PELAGE_POST_COLOR = 0, /* premultiplied light or coverage: averaged */
  PELAGE_POST_DATA = 1,  /* of the front-most pixel; zero where there is none */
  PELAGE_POST_DEPTH = 2  /* the same; infinite where there is none */
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
  float* target; /* first pixel */
  ptrdiff_t target_pixel_stride;
  ptrdiff_t target_row_stride;
} pelage_post_channel;

typedef struct pelage_post_image {
  size_t size;       /* sizeof(pelage_post_image) */
  int width, height; /* at most 65535 */
  const pelage_post_channel* channels;
  size_t channel_count;
  pelage_post_plane depth;              /* words NULL: everything has the same distance */
  pelage_post_plane alpha;              /* words NULL: every pixel is covered */
  pelage_post_plane motion_x, motion_y; /* only for pelage_motion_blur */
} pelage_post_image;

/* Called from any thread with the fraction done, 0 to 1; a non-zero result stops the work. */
typedef int (*pelage_post_progress)(void* user, double done);

typedef struct pelage_post_options {
  size_t size;          /* sizeof(pelage_post_options) */
  int scale;            /* samples per pixel and side, 1 to 8 */
  int threads;          /* 0: all */
  float shutter;        /* motion blur: open for this many frames */
  float centre;         /* motion blur: its centre, in frames from the rendered instant */
  int steps;            /* motion blur: 0: about one per pixel of motion */
  float focal_pixels;   /* stereo */
  float eye_separation; /* stereo: scene units, positive to the right */
  float convergence;    /* stereo: scene units; infinity for none */
  int box_filter;       /* stereo: 0: Lanczos */
  int longest_fill;     /* max pixels to fill in a gap, up to 65535; -1: all for stereo,
                           4 for blur */
  float* invented;      /* stereo: NULL, or width * height floats: the filled fraction of each pixel */
  pelage_post_progress progress; /* NULL: none */
  void* user;
  char message[160]; /* out: the error, or empty */
} pelage_post_options;

/* Sets size, and every other member to its default. */
PELAGE_POST_API void pelage_post_defaults(pelage_post_options* options);

PELAGE_POST_API pelage_post_result pelage_motion_blur(const pelage_post_image* image,
                                                      pelage_post_options* options);
PELAGE_POST_API pelage_post_result pelage_stereo(const pelage_post_image* image,
                                                 pelage_post_options* options);

#ifdef __cplusplus
}
#endif
#endif
