// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_strands.h"

#include <algorithm>

#include "geom/alembic/alembic_curves_file.h"
#include "geom/io/strand_formats.h"

namespace pelage {
namespace {

class AlembicStrands final : public HeldStrands {
 public:
  AlembicStrands(const std::filesystem::path& path, UsdCurvesFile read)
      : HeldStrands(path.string(), "alembic", std::move(read.strands)) {
    has_widths = read.has_widths;
    warnings = std::move(read.warnings);
  }
};

}  // namespace

std::unique_ptr<RawStrands> open_alembic(const std::filesystem::path& path,
                                         const StrandReadOptions& options) {
  return std::make_unique<AlembicStrands>(
      path, read_alembic_curves(path, {std::min(options.max_bytes, UsdCurvesOptions().max_bytes)}));
}

void write_alembic(const std::filesystem::path& path, const Strands& strands, bool widths) {
  write_alembic_strands(path, strands, alembic_facts(path, widths));
}

AlembicCurvesFacts alembic_facts(const std::filesystem::path& path, bool widths, AlembicHost host) {
  return {widths, path.stem().string(), host};
}

void write_alembic_strands(const std::filesystem::path& path, const Strands& strands,
                           const AlembicCurvesFacts& facts) {
  AlembicWriter writer(path);
  AlembicObjectWriter top(writer, "", {}), groom = alembic_groom(writer, "groom");
  add_alembic_curves(writer, groom, "hair", strands, facts);
  top.add(std::move(groom));
  writer.finish(std::move(top));
}

}  // namespace pelage
