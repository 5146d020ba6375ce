/* SPDX-License-Identifier: Apache-2.0 */
/* A renderer written in C, without anything of Pelage's, that loads the plugin and counts the strands it gets.
   renderer PLUGIN ARGUMENTS */
#include <dlfcn.h>
#include <stdio.h>

typedef void (*subdivide_function)(void*, float);
typedef void (*free_function)(void*);

enum { kMost = 10000 };
static struct {
  void* data;
  subdivide_function subdivide;
  free_function release;
} waiting[kMost];
static int waiting_count, strands, errors;

void RiBasis(float (*u)[4], int ustep, float (*v)[4], int vstep) { (void)u, (void)ustep, (void)v, (void)vstep; }
void RiMotionBeginV(int count, float* times) { (void)count, (void)times; }
void RiMotionEnd(void) {}
void RiCurvesV(char* type, int count, int* vertices, char* wrap, int parameters, char** tokens, void** values) {
  (void)type, (void)vertices, (void)wrap, (void)parameters, (void)tokens, (void)values;
  strands += count;
}
void RiProcedural(void* data, float* bound, subdivide_function subdivide, free_function release) {
  (void)bound;
  if (waiting_count == kMost) return;
  waiting[waiting_count].data = data;
  waiting[waiting_count].subdivide = subdivide;
  waiting[waiting_count++].release = release;
}
void RiErrorPrint(int code, int severity, char* message) {
  printf("%d %d %s\n", code, severity, message);
  ++errors;
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  void* plugin = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
  if (!plugin) {
    printf("%s\n", dlerror());
    return 1;
  }
  void* (*convert)(char*) = (void* (*)(char*))dlsym(plugin, "ConvertParameters");
  RiProcedural(convert(argv[2]), NULL, (subdivide_function)dlsym(plugin, "Subdivide"),
               (free_function)dlsym(plugin, "Free"));
  while (waiting_count > 0) {
    --waiting_count;
    void* data = waiting[waiting_count].data;
    free_function release = waiting[waiting_count].release;
    waiting[waiting_count].subdivide(data, 1e38f);
    release(data);
  }
  printf("%d strands, %d errors\n", strands, errors);
  return 0;
}
