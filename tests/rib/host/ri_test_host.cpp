// SPDX-License-Identifier: Apache-2.0
#include "tests/rib/host/ri_test_host.h"

#include <cstring>

#include <fmt/format.h>

#include "geom/curve_bounds.h"

namespace pelage {
namespace {

struct Pending {
  void* data;
  Box3f bound;
  RtSubdivideFunction subdivide;
  RtFreeFunction free;
  int depth;
};

/// The procedural that a thread runs.
struct Running {
  RiCalls calls;
  std::vector<Pending> pending;
  Box3f bound;  // of the procedural that is being divided; empty: unlimited
  int depth = 0;
  bool pinned = false;
  int keys = 0;                     // of the open motion block
  std::vector<StrandArrays> block;  // one item per key
};
thread_local Running* running = nullptr;

// Bounds are enlarged by 2^-21 of their largest coordinate before they are handed over, so the strands, which
// are measured again from their points, are inside without any tolerance but for that enlargement.
bool inside(const Box3f& box, const Box3f& outer) {
  const float slack =
      0x1p-20f * std::max(max_component(outer.max), -std::min({outer.min.x, outer.min.y, outer.min.z}));
  for (int axis = 0; axis < 3; ++axis) {
    if (box.min[axis] < outer.min[axis] - slack || box.max[axis] > outer.max[axis] + slack) return false;
  }
  return true;
}

void fault(const std::string& what) { running->calls.faults.push_back(what); }

const void* value_of(const char* declaration, int count, char** tokens, void** values) {
  for (int i = 0; i < count; ++i) {
    if (std::strcmp(tokens[i], declaration) == 0) return values[i];
  }
  return nullptr;
}

/// The strands of a call, without phantom points.
StrandArrays strands_of(int count, const int* vertices, const float* p, const float* width, const int* id) {
  StrandArrays arrays;
  arrays.first_point.push_back(0);
  for (int s = 0; s < count; ++s) {
    const int points = vertices[s] - 2;
    for (int i = 1; i <= points; ++i)
      arrays.points.insert(arrays.points.end(), {p[3 * i], p[3 * i + 1], p[3 * i + 2], 0.5f * *width++});
    for (const auto& [phantom, end, next] :
         {std::array{0, 1, 2}, std::array{points + 1, points, points - 1}}) {
      for (int axis = 0; axis < 3; ++axis) {
        if (p[3 * phantom + axis] != 2.0f * p[3 * end + axis] - p[3 * next + axis])
          fault("wrong phantom point");
      }
    }
    p += 3 * vertices[s];
    arrays.first_point.push_back(arrays.first_point.back() + static_cast<uint32_t>(points));
    arrays.ids.push_back(static_cast<uint64_t>(static_cast<uint32_t>(id[s])));
  }
  return arrays;
}

/// Takes the strands of one call or of one motion block.
void take(std::vector<StrandArrays> keys) {
  StrandArrays all = std::move(keys[0]);
  all.motion_keys = static_cast<int>(keys.size());
  for (size_t key = 1; key < keys.size(); ++key) {
    if (keys[key].ids != all.ids || keys[key].first_point != all.first_point)
      return fault("keys differ in their strands");
    all.points.insert(all.points.end(), keys[key].points.begin(), keys[key].points.end());
  }
  const Strands strands(std::move(all));
  const Box3f box = exact_bounds(strands);
  if (!running->bound.isEmpty() && !inside(box, running->bound)) fault("hair beyond the bound");
  running->calls.box.extendBy(box);
  ++running->calls.curves;
  add_strands(strands, running->calls.strands);
}

}  // namespace

RiCalls RiTestHost::run(const std::string& arguments, float detail, const Box3f* bound, int max_depth) const {
  const auto convert = reinterpret_cast<void* (*)(char*)>(plugin_.symbol("ConvertParameters"));
  Running own;
  running = &own;
  std::string text = arguments;
  own.pending.push_back({convert(text.data()), bound ? *bound : Box3f(),
                         reinterpret_cast<RtSubdivideFunction>(plugin_.symbol("Subdivide")),
                         reinterpret_cast<RtFreeFunction>(plugin_.symbol("Free")), 0});
  text.assign(text.size(), '?');  // the plugin must have a copy
  while (!own.pending.empty()) {
    const Pending next = own.pending.back();
    own.pending.pop_back();
    own.bound = next.bound;
    own.depth = next.depth;
    if (next.depth <= max_depth) next.subdivide(next.data, detail);
    next.free(next.data);
    if (next.depth > 0) ++own.calls.freed;
    if (own.keys != 0) fault("motion block without an end");
  }
  running = nullptr;
  return std::move(own.calls);
}

void RiTestHost::convert(const std::string& arguments) const {
  std::string text = arguments;
  void* data = reinterpret_cast<void* (*)(char*)>(plugin_.symbol("ConvertParameters"))(text.data());
  reinterpret_cast<RtFreeFunction>(plugin_.symbol("Free"))(data);
}

}  // namespace pelage

// The functions of a renderer, which the plugin finds by name.
#define RI_FUNCTION __attribute__((visibility("default"), used))

extern "C" {

RI_FUNCTION void RiBasis(float (*u)[4], int ustep, float (*)[4], int vstep) {
  using pelage::running;
  running->pinned = ustep == 1 && vstep == 1 && std::abs(u[3][1] - 4.0f / 6) < 1e-7f;
}

RI_FUNCTION void RiMotionBeginV(int count, float* times) {
  using pelage::running;
  running->keys = count;
  running->calls.times.assign(times, times + count);
  ++running->calls.motion_blocks;
}

RI_FUNCTION void RiMotionEnd() {
  using pelage::running;
  if (running->block.size() != static_cast<size_t>(running->keys))
    pelage::fault("wrong number of motion keys");
  running->keys = 0;
  pelage::take(std::move(running->block));
  running->block.clear();
}

RI_FUNCTION void RiCurvesV(char* type, int count, int* vertices, char* wrap, int parameters, char** tokens,
                           void** values) {
  using namespace pelage;
  if (std::string(type) != "cubic" || std::string(wrap) != "nonperiodic" || !running->pinned)
    return fault("unexpected kind of curve");
  const auto* p = static_cast<const float*>(value_of("P", parameters, tokens, values));
  const auto* width = static_cast<const float*>(value_of("varying float width", parameters, tokens, values));
  const auto* id = static_cast<const int*>(value_of("uniform integer id", parameters, tokens, values));
  if (!p || !width || !id) return fault("a parameter is missing");
  if (value_of("uniform color Cs", parameters, tokens, values))
    running->calls.colored += static_cast<size_t>(count);
  StrandArrays strands = strands_of(count, vertices, p, width, id);
  if (running->keys > 0) {
    running->block.push_back(std::move(strands));
  } else {
    std::vector<StrandArrays> one;
    one.push_back(std::move(strands));
    take(std::move(one));
  }
}

RI_FUNCTION void RiProcedural(void* data, float* bound, void (*subdivide)(void*, float),
                              void (*free)(void*)) {
  using namespace pelage;
  const Box3f box(V3f(bound[0], bound[2], bound[4]), V3f(bound[1], bound[3], bound[5]));
  if (!running->bound.isEmpty() && !inside(box, running->bound)) fault("a procedural beyond the bound");
  ++running->calls.procedurals;
  running->pending.push_back({data, box, subdivide, free, running->depth + 1});
}

RI_FUNCTION void RiErrorPrint(int, int severity, char* message) {
  using namespace pelage;
  if (severity != 2) fault("unexpected severity");
  if (running) running->calls.errors.push_back(message);
}
}
