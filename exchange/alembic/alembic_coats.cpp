// SPDX-License-Identifier: Apache-2.0
#include "exchange/alembic/alembic_coats.h"

#include "base/memory_budget.h"
#include "exchange/still_geometry.h"
#include "geom/alembic/alembic_curves_writer.h"
#include "geom/interchange/unique_names.h"
#include "geom/strand_merge.h"
#include "rib/host/coat_tree.h"

namespace pelage {
namespace {

std::string name_of(const FrameCoat& coat) { return coat.character + "." + coat.groom; }

class AlembicFrame {
 public:
  AlembicFrame(const std::filesystem::path& path, ExportNotes& notes, const Job& job)
      : writer_(path), notes_(notes), job_(job) {}

  void write(const std::vector<FrameCoat>& coats) {
    AlembicObjectWriter top(writer_, "", {});
    UniqueNames characters;
    // The coats of a character follow each other.
    for (size_t first = 0, end = 0; first < coats.size(); first = end) {
      const std::string& character = coats[first].character;
      while (end < coats.size() && coats[end].character == character) ++end;
      AlembicObjectWriter object = alembic_groom(writer_, characters.unique(character));
      UniqueNames grooms;
      for (size_t i = first; i < end; ++i) write_coat(coats[i], grooms.unique(coats[i].groom), object);
      top.add(std::move(object));
    }
    writer_.finish(std::move(top));
  }

 private:
  void write_coat(const FrameCoat& coat, const std::string& name, AlembicObjectWriter& character) {
    const CoatTree tree(coat, std::nullopt);
    std::vector<Strands> leaves(tree.all().end);
    int64_t bytes = 0;  // the leaves, and their copy in one batch
    for (size_t leaf = 0; leaf < leaves.size(); ++leaf) bytes += 2 * tree.growth_bytes(leaf);
    const MemoryCharge charge =
        reserve(job_.ledger, MemoryTag::kChunks, bytes, "the strands of " + name_of(coat));
    {
      const ProgressStage stage(job_.progress, "grow " + name_of(coat), static_cast<double>(leaves.size()));
      job_.for_each(leaves.size(), 1, [&](WorkRange range) {
        for (size_t leaf = range.begin; leaf < range.end; ++leaf) {
          leaves[leaf] = still_strands(tree.grow(leaf));
          stage.advance(1);
        }
      });
    }
    const Strands strands = merge(leaves, job_.workers);
    if (strands.strand_count() == 0) return;
    const AlembicCurvesFacts facts{true, name_of(coat), AlembicHost::kAny};
    for (const std::string& attribute : lost_alembic_attributes(strands, facts))
      notes_.add("coat '" + name_of(coat) + "'", "the attribute " + attribute + " is lost");
    add_alembic_curves(writer_, character, name, strands, facts);
  }

  AlembicWriter writer_;
  ExportNotes& notes_;
  const Job& job_;
};

}  // namespace

std::vector<std::filesystem::path> write_alembic_coats(const std::filesystem::path& folder,
                                                       const ExportSource& source, ExportNotes& notes,
                                                       const Job& job) {
  notes.add("scene", "the files hold only strands: no skins, materials, lights or cameras");
  std::vector<std::filesystem::path> paths;
  const std::vector<int>& frames = source.scene.frames.frames;
  for (const int frame : frames) {
    const std::string suffix = frames.size() > 1 ? fmt::format(".{:04}", frame) : "";
    const FrameParts parts = pose_frame(source.scene, source.assets, frame, job);
    for (const FrameCoat& coat : parts.coats) {
      if (coat.skin->motion_keys() > 1)
        notes.add("motion",
                  "there is no motion blur: strands are where they are in the middle of the shutter");
    }
    paths.push_back(folder / (source.path.stem().string() + suffix + ".abc"));
    AlembicFrame(paths.back(), notes, job).write(parts.coats);
  }
  return paths;
}

}  // namespace pelage
