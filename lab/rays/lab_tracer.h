// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lab/rays/lab_rays.h"

namespace pelage {

/// An accelerator configuration under test.
struct LabVariant {
  enum class Kind {
    kPrepare,        ///< no tracing: grows the fur, makes the rays, writes the pages
    kEmbreeFast,     ///< Embree's default layout
    kEmbreeCompact,  ///< Embree's compact layout
    kFur128,         ///< the fur tree with float nodes
    kFur64,          ///< the fur tree with quantised nodes
    kPaged,          ///< as kFur64, but pages are read from a file
  };
  Kind kind = Kind::kFur64;
  /// For kPaged: memory relative to the size of the tree. 1: enough for the whole tree, in addition to the
  /// always resident part.
  double share = 1;
  std::vector<std::string> kinds;  ///< kinds of rays to trace; empty: all

  static const std::vector<std::string>& names();
  /// Throws Error (kArguments) with the nearest name.
  static Kind parse(const std::string& name);
};

/// Cost of rays of one kind; sums over all of them.
struct LabCost {
  double wall_s = 0, cpu_s = 0;  ///< time of the fastest timed pass
  double rays = 0, hits = 0;
  double answers = 0;    ///< a checksum that any other answer would change; 0 for Embree
  double box_tests = 0;  ///< 0 where unknown
  double segment_tests = 0;
  double page_faults = 0;  ///< pages read in that pass
  double bytes_read = 0;
};

/// Results of one variant.
struct LabResult {
  double segments = 0;
  double bytes = 0;           ///< size of the tree and of the points that it reads
  double resident_bytes = 0;  ///< max charged to `chunks` while rays were traced
  double limit_bytes = 0;     ///< its memory limit; 0: none
  double build_cpu_s = 0;
  std::map<std::string, LabCost> rays;  ///< by kind
};

/// Builds a variant over the fur of a folder and traces its rays. Throws Error; kMemory when a share of the
/// tree's size is not enough for its table and one page per thread; kArguments when there are no rays of a
/// kind.
LabResult trace_lab_rays(const LabVariant& variant, const ContentStore& store, const Job& job);

/// Fills the folder. Passes on errors of growth.
LabResult prepare_lab(const RenderScene& scene, const ContentStore& store, size_t max_rays, const Job& job);

}  // namespace pelage
