/* SPDX-License-Identifier: Apache-2.0 */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* The C interface between the operator `python` and the module that contains CPython
 * (python/scripts/script_module.cpp). Its functions throw no exceptions and have no C++ types. They may be
 * called from any thread, also at the same time; the module takes the lock of the interpreter. */

#define PELAGE_SCRIPTS_VERSION 1
#define PELAGE_SCRIPTS_EXPORT __attribute__((visibility("default")))

#ifdef __cplusplus
extern "C" {
#endif

/* The strands of a batch. All arrays are ordered by strand; vectors have three floats. Lengths are in the
 * space of the batch. */
typedef struct PelageScriptBatch {
  size_t strands;
  size_t points;            /* of each strand */
  size_t color_rows;        /* colours of each strand: 0, 1, or one per point */
  uint64_t seed;            /* of the operator */
  int writes_colors;        /* whether the function may return colours */
  float scale;              /* length in the space of the batch of a scene unit */
  const uint64_t* ids;      /* [strands] */
  const float* positions;   /* [strands][points][3], relative to the root */
  const float* widths;      /* [strands][points], diameters */
  const float* colors;      /* [strands][color_rows][3] */
  const float* roots;       /* [strands][3] */
  const float* frames;      /* [strands][3][3]: tangent, bitangent, normal */
  const float* rest_roots;  /* as roots, in rest space */
  const float* rest_frames; /* as frames, in rest space */
  const float* uv;          /* [strands][2], texture coordinates of the roots */
  const float* clump;       /* [strands], random number of the clump */
  /* What the function returns. What it does not return keeps its values. */
  float* new_positions;
  float* new_widths;
  float* new_colors;
} PelageScriptBatch;

typedef struct PelageScriptFault {
  int line; /* of the file of the script; 0: none */
  char message[1000];
} PelageScriptFault;

/* A function of a script, with its arguments. */
typedef struct PelageScript PelageScript;

PELAGE_SCRIPTS_EXPORT int pelage_scripts_version(void);

/* Runs the source of a script. `path`: its file, for messages. `function`: the function of the script to
 * call. `arguments`: a JSON object with the keyword arguments of every call. Starts the interpreter if the
 * process has none. Returns null on failure. */
PELAGE_SCRIPTS_EXPORT PelageScript* pelage_script_open(const char* path, const char* source,
                                                       const char* function, const char* arguments,
                                                       PelageScriptFault* fault);
PELAGE_SCRIPTS_EXPORT void pelage_script_close(PelageScript* script);

/* Calls the function for a batch. Returns 0 on success, else 1. */
PELAGE_SCRIPTS_EXPORT int pelage_script_run(PelageScript* script, const PelageScriptBatch* batch,
                                            PelageScriptFault* fault);

#ifdef __cplusplus
}
#endif
