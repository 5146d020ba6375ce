/* SPDX-License-Identifier: Apache-2.0 */
#pragma once

#include <stddef.h>

/* The C border between the texture library and the module that holds OpenImageIO (image/reader_module.cpp).
 * Neither exceptions nor types of C++ cross it. */

#define PELAGE_IMAGE_READER_VERSION 1

#ifdef __cplusplus
extern "C" {
#endif

typedef struct PelageImageInfo {
  int width;
  int height;
  int channels;   /* 1 .. 4; further ones are not read */
  int is_integer; /* stored as whole numbers, whose values come as 0 .. 1 */
} PelageImageInfo;

/* Receives an image in the order of its rows, so that nobody allocates what a damaged file only claims to
 * hold. Both return 0 to go on. `rows` gets whole rows from the top, channels interleaved, alpha not
 * multiplied in. */
typedef struct PelageImageSink {
  void* context;
  int (*begin)(void* context, const PelageImageInfo* info);
  int (*rows)(void* context, const float* pixels, size_t count);
} PelageImageSink;

__attribute__((visibility("default"))) int pelage_image_reader_version(void);

/* Reads the first image of a file. Returns 0, or 1 and one line in `message`. */
__attribute__((visibility("default"))) int pelage_read_image(const char* path, const PelageImageSink* sink,
                                                             char* message, size_t message_size);

#ifdef __cplusplus
}
#endif
