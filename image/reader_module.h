/* SPDX-License-Identifier: Apache-2.0 */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* The C interface between the texture library and the module that contains OpenImageIO
 * (image/reader_module.cpp, image/tile_cache_module.cpp). No exceptions or C++ types cross it. */

#define PELAGE_IMAGE_READER_VERSION 2
#define PELAGE_EXPORT __attribute__((visibility("default")))

#ifdef __cplusplus
extern "C" {
#endif

enum { PELAGE_TEXEL_U8, PELAGE_TEXEL_U16, PELAGE_TEXEL_HALF, PELAGE_TEXEL_FLOAT };

typedef struct PelageImageInfo {
  int width;
  int height;
  int channels;          /* 1 .. 4; further ones are not read */
  int kind;              /* PELAGE_TEXEL_...: of the values that rows() receives */
  int is_integer;        /* stored as integers */
  int64_t working_bytes; /* estimated temporary memory of reading */
} PelageImageInfo;

/* Receives an image row by row, so that memory is not allocated for rows that a damaged file only claims to
 * contain. begin() receives the header. Both return 0 to continue. rows() receives `count` whole rows from
 * the top, channels interleaved, colours not premultiplied by alpha. */
typedef struct PelageImageSink {
  void* context;
  int (*begin)(void* context, const PelageImageInfo* info);
  int (*rows)(void* context, const void* rows, int count);
} PelageImageSink;

PELAGE_EXPORT int pelage_image_reader_version(void);

/* Reads the first image of a file. Returns 0, or 1 and one line in `message`. */
PELAGE_EXPORT int pelage_read_image(const char* path, const PelageImageSink* sink, char* message,
                                    size_t message_size);

/* A cache of tiles in a bounded amount of memory, for files of tiles (see PelageTiles). Thread safe. */
typedef struct PelageTileCache PelageTileCache;
typedef struct PelageTileImage PelageTileImage;

/* A file of square tiles, stored row by row; each tile is complete (those at the right and lower edges are
 * padded) and contains its texels row by row. */
typedef struct PelageTiles {
  int descriptor; /* must stay open while the cache is in use */
  int width, height;
  int side; /* of a tile, in texels */
  int texel_bytes;
} PelageTiles;

/* Smallest size limit that a cache respects. */
#define PELAGE_SMALLEST_TILE_CACHE (10 << 20)

PELAGE_EXPORT PelageTileCache* pelage_tile_cache_create(int64_t bytes);
PELAGE_EXPORT void pelage_tile_cache_destroy(PelageTileCache* cache);
/* Null on failure. The image lives as long as the cache. */
PELAGE_EXPORT PelageTileImage* pelage_tile_cache_add(PelageTileCache* cache, const PelageTiles* tiles);
/* Copies the texels of a rectangle inside the image to `to`, row after row. Returns 0 on success. */
PELAGE_EXPORT int pelage_tile_cache_read(PelageTileImage* image, int x, int y, int width, int height,
                                         void* to);

#ifdef __cplusplus
}
#endif
