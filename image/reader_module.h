/* SPDX-License-Identifier: Apache-2.0 */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* The C border between the texture library and the module that holds OpenImageIO (image/reader_module.cpp,
 * image/tile_cache_module.cpp). Neither exceptions nor types of C++ cross it. */

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
  int is_integer;        /* stored as whole numbers */
  int64_t working_bytes; /* estimate of what reading takes while it lasts */
} PelageImageInfo;

/* Receives an image in the order of its rows, so that nobody allocates what a damaged file only claims to
 * hold. begin() has the header alone. Both return 0 to go on. rows() receives `count` whole rows from the
 * top, channels interleaved, alpha not multiplied in. */
typedef struct PelageImageSink {
  void* context;
  int (*begin)(void* context, const PelageImageInfo* info);
  int (*rows)(void* context, const void* rows, int count);
} PelageImageSink;

PELAGE_EXPORT int pelage_image_reader_version(void);

/* Reads the first image of a file. Returns 0, or 1 and one line in `message`. */
PELAGE_EXPORT int pelage_read_image(const char* path, const PelageImageSink* sink, char* message,
                                    size_t message_size);

/* A bounded store of tiles in memory, in front of files of tiles (see PelageTiles). Thread safe. */
typedef struct PelageTileCache PelageTileCache;
typedef struct PelageTileImage PelageTileImage;

/* A file of square tiles: row after row of tiles, each complete (those at the right and lower edges are
 * filled up), a tile being row after row of texels. */
typedef struct PelageTiles {
  int descriptor; /* open for as long as the cache is read */
  int width, height;
  int side; /* of a tile, in texels */
  int texel_bytes;
} PelageTiles;

/* Smallest size that a cache keeps to. */
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
