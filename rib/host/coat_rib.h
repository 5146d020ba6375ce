// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "base/job.h"
#include "rib/host/coat_tree.h"
#include "rib/host/rib_file.h"
#include "world/hair_arguments.h"

namespace pelage {

/// How the coats of a scene are written.
enum class RibCoats {
  kProcedurals,  ///< one Procedural per coat, which a renderer grows with libpelage_ri.so
  kArchives,     ///< one Procedural "DelayedReadArchive" per leaf, and one file per leaf
  kExpanded,     ///< Curves
};

/// Grows the leaves of a coat, with all threads of the job, and calls `use` for each leaf that has strands,
/// in the order of the leaves, on the calling thread. Throws Error: kMemory if one leaf does not fit the
/// memory limit, kStopped when the job is stopped.
void for_each_leaf(const CoatTree& tree, const Job& job,
                   const std::function<void(size_t leaf, const Strands& strands)>& use);

/// Writes Procedural "DynamicLoad" with the exact box of the coat. Writes nothing for a coat without strands.
void write_procedural(RibWriter& rib, const CoatTree& tree, const HairArguments& arguments, const Job& job);

/// Writes a file for each leaf that has strands, and a Procedural "DelayedReadArchive" with the exact box of
/// the leaf for each. The files are `base` with the number of the leaf and ".rib" or ".rib.gz" appended.
/// Their names in the stream are relative to the folder of `folder_of`. No symbolic link is followed in the
/// folder of the files: a link with the name of a file is replaced, and a folder that is a link is refused.
void write_archives(RibWriter& rib, const CoatTree& tree, std::span<const float> times,
                    const std::filesystem::path& base, const std::filesystem::path& folder_of,
                    const RibFormat& format, const Job& job);

/// Writes the Curves of all leaves.
void write_expanded(RibWriter& rib, const CoatTree& tree, std::span<const float> times, const Job& job);

/// Writes the six numbers of a bound.
void write_bound(RibWriter& rib, const Box3f& box);

}  // namespace pelage
