/* SPDX-License-Identifier: Apache-2.0 */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* The C interface between the texture library and the module that contains OpenImageIO
 * (image/reader_module.cpp, image/writer_module.cpp, image/tile_cache_module.cpp). Its functions throw no
 * exceptions and have no C++ types. */

#define PELAGE_IMAGE_READER_VERSION 3
#define PELAGE_EXPORT __attribute__((visibility("default")))

#ifdef __cplusplus
extern "C" {
#endif

enum { PELAGE_TEXEL_U8, PELAGE_TEXEL_U16, PELAGE_TEXEL_HALF, PELAGE_TEXEL_FLOAT };

typedef struct PelageImageInfo {
  int width;
  int height;
  int channels;          /* 1 .. 4; further channels are not read */
  int kind;              /* PELAGE_TEXEL_...: type of the values that rows() receives */
  int is_integer;        /* 1 if the file stores integers, else 0 */
  int64_t working_bytes; /* estimated temporary memory of reading the file */
} PelageImageInfo;

/* Receives an image in strips of rows, so that memory is allocated only for rows that the file really
 * contains; the header of a damaged file may claim more rows. begin() is called first, with the header. Then
 * rows() is called with `count` whole rows at a time, from the top; channels are interleaved, and colours are
 * not premultiplied by alpha. Both functions return 0 to continue, any other value to stop. */
typedef struct PelageImageSink {
  void* context;
  int (*begin)(void* context, const PelageImageInfo* info);
  int (*rows)(void* context, const void* rows, int count);
} PelageImageSink;

PELAGE_EXPORT int pelage_image_reader_version(void);

/* Reads the first image of a file. Returns 0 on success and 1 on failure or when the sink stops. On failure,
 * `message` receives one line of text. */
PELAGE_EXPORT int pelage_read_image(const char* path, const PelageImageSink* sink, char* message,
                                    size_t message_size);

/* Writes an image with 8 bits for each of the channels R, G and B, which are adjacent; rows from the top. The
 * extension of the path states the format. JPEG files have quality 95. Returns 0 on success and 1 on failure;
 * `message` then receives one line of text. */
PELAGE_EXPORT int pelage_write_image(const char* path, int width, int height, const uint8_t* rgb,
                                     char* message, size_t message_size);

/* A cache of tiles with a limit on memory. Reads the tiles from files (see PelageTiles). Thread safe. */
typedef struct PelageTileCache PelageTileCache;
typedef struct PelageTileImage PelageTileImage;

/* A file of square tiles. The tiles are stored from left to right and from top to bottom, and so are the
 * texels of each tile. All tiles have the same size; tiles beyond the right and lower edges of the image are
 * padded. */
typedef struct PelageTiles {
  int descriptor; /* must stay open while the cache is in use */
  int width, height;
  int side; /* side length of a tile, in texels */
  int texel_bytes;
} PelageTiles;

/* Smallest memory limit of a cache, in bytes. Smaller limits are raised to this value. */
#define PELAGE_SMALLEST_TILE_CACHE (10 << 20)

/* Creates a cache with a memory limit of `bytes`. Returns null on failure. */
PELAGE_EXPORT PelageTileCache* pelage_tile_cache_create(int64_t bytes);
PELAGE_EXPORT void pelage_tile_cache_destroy(PelageTileCache* cache);
/* Adds a file of tiles to a cache. Returns null on failure. The cache owns the returned image. */
PELAGE_EXPORT PelageTileImage* pelage_tile_cache_add(PelageTileCache* cache, const PelageTiles* tiles);
/* Copies the texels of a rectangle inside the image to `to`, row by row. Returns 0 on success, else 1. */
PELAGE_EXPORT int pelage_tile_cache_read(PelageTileImage* image, int x, int y, int width, int height,
                                         void* to);

#ifdef __cplusplus
}
#endif
