// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "geom/io/binary_file.h"
#include "geom/io/strand_file.h"

// What the formats behind geom/io/strand_file.h have in common.

namespace pelage {

class AtomicFile;

StrandFile read_hair(const std::filesystem::path& path, const StrandReadOptions& options);
void write_hair(const std::filesystem::path& path, const Strands& strands);
StrandFile read_tfx(const std::filesystem::path& path, const StrandReadOptions& options);
void write_tfx(const std::filesystem::path& path, const Strands& strands);

/// Reads `count` records of `components` floats at `offset` into every fourth float and its followers of
/// `points` (x, y, z, r), a few thousand at a time.
void read_point_parts(BinaryFile& file, uint64_t offset, int components, size_t count, float* points);

/// Calls `value(point, out)` for every point of every strand and writes the `components` floats it gives.
void write_per_point(AtomicFile& file, const Strands& strands, int components,
                     const std::function<void(size_t strand, size_t point, float* out)>& value);

/// Value of an attribute at a point of a strand; `components` many, missing ones filled with the last.
void attribute_at(const StrandAttribute& attribute, size_t strand, size_t point, int components, float* out);

/// Repairs what was read, with the widths that the options, the file (`file_width` > 0) or a guess say.
StrandFile finish_strands(StrandArrays arrays, const char* format, const StrandReadOptions& options,
                          bool has_widths, float file_width);

/// Throws Error (kFailed): "path: why".
[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& why);

}  // namespace pelage
