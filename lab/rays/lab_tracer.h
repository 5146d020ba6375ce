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
    /// Prepares the other variants: grows the fur, makes the rays and writes the pages; traces nothing.
    kPrepare,
    kEmbreeFast,     ///< Embree's default layout
    kEmbreeCompact,  ///< Embree's compact layout
    kFur128,         ///< the fur tree with float nodes
    kFur64,          ///< the fur tree with quantised nodes
    kPaged,          ///< the fur tree with quantised nodes, in pages that are read from a file when needed
  };
  Kind kind = Kind::kFur64;
  /// For kPaged: memory as a fraction of the size of the tree. 1: enough for all pages, in addition to the
  /// part that is always resident.
  double share = 1;
  std::vector<std::string> kinds;  ///< kinds of rays to trace; empty: all kinds

  /// Names of the variants, in the order of Kind.
  static const std::vector<std::string>& names();
  /// Returns the variant with this name. For an unknown name, throws Error (kArguments) that suggests the
  /// nearest known name.
  static Kind parse(const std::string& name);
};

/// Cost of tracing the rays of one kind. Numbers are sums over all these rays.
struct LabCost {
  double wall_s = 0, cpu_s = 0;  ///< wall and CPU time of the timed pass with the shortest wall time
  double rays = 0, hits = 0;
  double answers = 0;        ///< checksum that changes if any answer changes; 0 for Embree
  double box_tests = 0;      ///< number of boxes tested; 0 where unknown
  double segment_tests = 0;  ///< number of segments tested; 0 where unknown
  double page_faults = 0;    ///< number of pages read in the same pass
  double bytes_read = 0;     ///< bytes read in the same pass
};

/// Results of one variant.
struct LabResult {
  double segments = 0;
  double bytes = 0;           ///< size of the tree, including the points that it needs
  double resident_bytes = 0;  ///< max of the ledger's tag `chunks` while rays were traced
  double limit_bytes = 0;     ///< memory limit of the variant; 0: none
  double build_cpu_s = 0;
  std::map<std::string, LabCost> rays;  ///< by kind of rays
};

/// Builds a variant for the prepared fur in `store`, and traces the prepared rays. Throws Error: kMemory when
/// `share` is too small for the table of pages and one page per thread, kArguments for an unknown kind of
/// rays, kFailed when the prepared data cannot be read.
LabResult trace_lab_rays(const LabVariant& variant, const ContentStore& store, const Job& job);

/// Prepares `store` for trace_lab_rays(): grows the fur, makes the rays, and writes both and the pages of the
/// tree. Passes on errors of growth.
LabResult prepare_lab(const RenderScene& scene, const ContentStore& store, size_t max_rays, const Job& job);

}  // namespace pelage
