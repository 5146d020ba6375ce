// SPDX-License-Identifier: Apache-2.0
#include "cli/output_files.h"

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_file.h"
#include "geom/io/strand_file.h"

namespace pelage {

void check_replaces_none(const std::string& flag, const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& kept) {
  for (const std::filesystem::path& file : kept) {
    if (same_file(output, file)) {
      throw Error(ErrorKind::kArguments, flag + " " + output.string() + ": would overwrite " +
                                             (file == output ? "a file that" : file.string() + ", which") +
                                             " this run reads or writes itself; choose another name");
    }
  }
}

void check_stats(const RunOptions& options, const std::vector<std::filesystem::path>& kept) {
  if (options.stats) check_replaces_none("--stats", *options.stats, kept);
}

void prepare_output(const std::filesystem::path& path) {
  const AtomicFile probe(path);
  sweep_temporaries(target_of_links(path).parent_path());
}

void warn_of_losses(const std::filesystem::path& path, const Strands& strands, Progress& progress) {
  const std::string lost = what_is_lost(path, strands);
  if (lost.empty()) return;
  progress.warn(path.string() + ": " + path.extension().string() + " files cannot hold " + lost);
}

}  // namespace pelage
