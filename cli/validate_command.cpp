// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include <fmt/format.h>

#include "cli/commands.h"
#include "geom/alembic/alembic_validation.h"
#include "geom/io/mesh_file.h"
#include "geom/io/strand_file.h"
#include "geom/usd/usd_validation.h"

namespace pelage {
namespace {

constexpr size_t kMaxFindings = 20;

void print_lines(const char* kind, const std::vector<std::string>& lines) {
  for (size_t i = 0; i < lines.size() && i < kMaxFindings; ++i) std::cout << kind << lines[i] << "\n";
  if (lines.size() > kMaxFindings) std::cout << kind << lines.size() - kMaxFindings << " more\n";
}

/// .hair and .tfx files have no times, extents or ids, so a reader finds everything.
ValidationReport validate_strands(const Options& options) {
  const StrandFile file = read_strands(options.input, {options.basis, options.default_width});
  ValidationReport findings;
  findings.curves = 1;
  findings.strands = file.strands.strand_count() + static_cast<size_t>(file.repairs.dropped);
  findings.points = file.strands.point_count();
  if (file.repairs.dropped > 0)
    findings.problems.push_back(
        fmt::format("{}: {} strands have too few points, no length, or points that are not finite",
                    options.input, file.repairs.dropped));
  if (file.repairs.repaired > 0)
    findings.problems.push_back(fmt::format("{}: {} strands have repeated points or unusable widths",
                                            options.input, file.repairs.repaired));
  if (file.assumed_width > 0) findings.problems.push_back(options.input + ": it has no widths");
  if (file.strands.arrays().root_uv.empty())
    findings.remarks.push_back(options.input + ": the roots have no texture coordinates");
  return findings;
}

}  // namespace

int run_validate(const Options& options) {
  if (!is_strand_file(options.input))
    throw Error(ErrorKind::kInput, {options.input, 0, 0},
                std::string("expected a file ending in ") + kStrandEndings);
  const ValidationReport findings = is_usd_file(options.input)       ? validate_usd(options.input)
                                    : is_alembic_file(options.input) ? validate_alembic(options.input)
                                                                     : validate_strands(options);
  std::cout << fmt::format("{}: {} strands of {} points, {} meshes\n", options.input, findings.strands,
                           findings.points, findings.meshes);
  print_lines("problem: ", findings.problems);
  print_lines("remark: ", findings.remarks);
  if (findings.problems.empty()) std::cout << "no problems\n";
  return findings.problems.empty() ? 0 : 3;
}

}  // namespace pelage
