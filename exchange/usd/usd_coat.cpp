// SPDX-License-Identifier: Apache-2.0
#include "exchange/usd/usd_coat.h"

#include <memory>

#include "base/file.h"
#include "geom/usd/usd_curves_writer.h"

namespace pelage {
namespace {

class UsdCoat {
 public:
  UsdCoat(const PosedFrames& frames, size_t coat) : frames_(frames), coat_(coat) {
    for (const size_t frame : frames.different_coats(coat)) {
      samples_.push_back(frame);
      trees_.push_back(std::make_unique<CoatTree>(frames.parts(frame).coats[coat], std::nullopt));
    }
    moves_ = samples_.size() > 1 || first().skin->motion_keys() > 1;
  }
  const CoatTree& tree() const { return *trees_[0]; }

  /// Writes the strands of a leaf. Returns nothing, and writes nothing, if it has none.
  std::optional<Box3f> write_leaf(const std::filesystem::path& file, const std::string& metadata,
                                  size_t leaf) const {
    Strands strands = trees_[0]->grow(leaf);
    if (strands.strand_count() == 0) return {};
    UsdCurvesFacts facts;
    facts.coat = first().character + "." + first().groom;
    facts.role = EnumNames<StrandRole>::names[static_cast<size_t>(first().coat->role())];
    const FollicleTree::Leaf& range = first().coat->follicles().leaves()[leaf];
    if (strands.strand_count() == range.end - range.begin) {
      for (uint32_t follicle = range.begin; follicle < range.end; ++follicle)
        facts.priority.push_back(first().coat->priority(follicle));
    }
    UsdWriter usd(file, metadata);
    bool grown = true;  // the strands of sample 0
    const Box3f extent = write_usd_curves(usd, "hair", facts, samples_.size(), [&](size_t i) {
      UsdCurvesSample sample;
      sample.strands = i == 0 && grown ? std::move(strands) : trees_[i]->grow(leaf);
      if (i == 0) grown = false;
      if (moves_) sample.times = frames_.times(samples_[i], sample.strands.motion_keys());
      return sample;
    });
    usd.commit();
    return extent;
  }

 private:
  const FrameCoat& first() const { return frames_.parts(0).coats[coat_]; }

  const PosedFrames& frames_;
  const size_t coat_;
  std::vector<size_t> samples_;
  std::vector<std::unique_ptr<CoatTree>> trees_;
  bool moves_;
};

}  // namespace

std::optional<Box3f> write_usd_coat(const std::filesystem::path& file, const std::string& metadata,
                                    const PosedFrames& frames, size_t coat, const Job& job) {
  const UsdCoat writer(frames, coat);
  const std::string stem = file.stem().string();
  const std::filesystem::path folder = file.parent_path() / stem;
  make_own_folder(folder);
  std::vector<std::optional<Box3f>> extents(writer.tree().all().end);
  for_each_leaf_at_once(writer.tree(), job, [&](size_t leaf) {
    const std::filesystem::path leaf_file = folder / fmt::format("leaf_{}.usda", leaf);
    extents[leaf] = writer.write_leaf(leaf_file, "defaultPrim = \"hair\"\n" + metadata, leaf);
  });
  Box3f whole;
  for (const std::optional<Box3f>& extent : extents) {
    if (extent) whole.extendBy(*extent);
  }
  if (whole.isEmpty()) return {};
  UsdWriter usd(file, "defaultPrim = \"coat\"\n" + metadata);
  usd.open("def Xform \"coat\"");
  for (size_t leaf = 0; leaf < extents.size(); ++leaf) {
    if (!extents[leaf]) continue;
    usd.open(fmt::format("def BasisCurves \"leaf_{}\" (payload = @{}/leaf_{}.usda@)", leaf, stem, leaf));
    usd.box("float3[] extent = ", *extents[leaf]);
    usd.close();
  }
  usd.close();
  usd.commit();
  return whole;
}

}  // namespace pelage
