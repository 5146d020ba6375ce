// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lab/rays/lab_rays.h"

namespace pelage {

/// What fur is traced with in a measurement.
struct LabVariant {
  enum class Kind {
    kPrepare,        ///< none: grows the fur, makes the rays, writes the pages
    kEmbreeFast,     ///< Embree's default layout
    kEmbreeCompact,  ///< its small one
    kFur128,         ///< the fur tree with nodes of floats
    kFur64,          ///< with quantised nodes
    kPaged,          ///< the same read from its file
  };
  Kind kind = Kind::kFur64;
  /// Of kPaged: memory over the size of the tree. 1: enough to hold all of it, beside what is always held.
  double share = 1;
  std::vector<std::string> kinds;  ///< of rays that are traced; empty: all

  static const std::vector<std::string>& names();
  /// Throws Error (kArguments) with the nearest name.
  static Kind parse(const std::string& name);
};

/// What rays of one kind cost; sums over all of them.
struct LabCost {
  double wall_s = 0, cpu_s = 0;  ///< of the fastest pass that was timed
  double rays = 0, hits = 0;
  double answers = 0;    ///< a sum that any other answer would change; 0 for Embree
  double box_tests = 0;  ///< 0 where it is not known
  double segment_tests = 0;
  double page_faults = 0;  ///< pages read in that pass
  double bytes_read = 0;
};

/// What one variant is like.
struct LabResult {
  double segments = 0;
  double bytes = 0;           ///< of the tree and the points it reads
  double resident_bytes = 0;  ///< most that was charged to `chunks` when rays were traced
  double limit_bytes = 0;     ///< what it was allowed; 0: no limit
  double build_cpu_s = 0;
  std::map<std::string, LabCost> rays;  ///< by kind
};

/// Builds a variant over the fur of a folder and traces its rays. Throws Error; kMemory when a share of the
/// tree's size is not enough for its table and a page per thread; kArguments when there are no rays of a
/// kind.
LabResult trace_lab_rays(const LabVariant& variant, const ContentStore& store, const Job& job);

/// Fills the folder. Throws as growing does.
LabResult prepare_lab(const RenderScene& scene, const ContentStore& store, size_t max_rays, const Job& job);

}  // namespace pelage
