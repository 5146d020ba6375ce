// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/temporary_folder.h"
#include "render/accel/fur/fur_page_file.h"
#include "tests/render/accel/fur/fur_grooms.h"

namespace pelage {

constexpr ContentHash kFurKey{12, 34};
constexpr size_t kSmallPages = size_t(4) << 10;

struct FurWarnings {
  std::vector<std::string> lines;
  WarningSink sink() {
    return [this](const std::string& line) { lines.push_back(line); };
  }
};

inline FurTreeOptions fur_options(FurNodeLayout layout, FurRotation rotation = FurRotation::kNever) {
  FurTreeOptions options;
  options.layout = layout;
  options.build.rotation = rotation;
  return options;
}

/// A groom, the tree over it in memory, and the same tree in a file.
struct StoredGroom {
  StoredGroom(const GroomShape& shape, size_t count, FurNodeLayout layout,
              FurRotation rotation = FurRotation::kNever, size_t page_bytes = kSmallPages)
      : strands(random_groom(shape, count, 7)),
        snapped(strands, FurGrid(shape.width)),
        tree(snapped, fur_options(layout, rotation)),
        store(folder.path()) {
    FurPageFile::Writer writer(store, kFurKey, page_bytes);
    writer.add(tree);
    writer.commit(warnings.sink());
  }
  FurPageFile open() { return FurPageFile::open(store, kFurKey, warnings.sink()).value(); }
  std::filesystem::path path() const { return std::filesystem::directory_iterator(folder.path())->path(); }

  Strands strands;
  SnappedStrands snapped;
  FurTree tree;
  TemporaryFolder folder;
  ContentStore store;
  FurWarnings warnings;
};

inline bool same_hit(const FurHit& a, const FurHit& b) {
  return a.number == b.number && (!a || (a.distance == b.distance && a.u == b.u && a.h == b.h));
}

}  // namespace pelage
