// SPDX-License-Identifier: Apache-2.0
#include "geom/io/alembic_strands.h"

#include "geom/alembic/alembic_curves_file.h"
#include "geom/io/strand_formats.h"

namespace pelage {

std::unique_ptr<RawStrands> open_alembic(const std::filesystem::path& path,
                                         const StrandReadOptions& options) {
  return std::make_unique<HeldStrands>(path, "alembic", read_alembic_curves(path, {options.max_bytes}));
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
