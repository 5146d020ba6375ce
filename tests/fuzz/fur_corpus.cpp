// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"
#include "base/temporary_folder.h"
#include "render/accel/fur/fur_page_file.h"
#include "tests/fuzz/corpus.h"
#include "tests/render/accel/fur/fur_grooms.h"

namespace pelage {
namespace {

FurTree small_tree(size_t strands, int motion_keys, FurNodeLayout layout,
                   FurRotation rotation = FurRotation::kNever) {
  GroomShape shape;
  shape.motion_keys = motion_keys;
  const Strands groom = random_groom(shape, strands, 3);
  FurTreeOptions options;
  options.layout = layout;
  options.build.rotation = rotation;
  return FurTree(SnappedStrands(groom, FurGrid(shape.width)), options);
}

}  // namespace

std::vector<std::string> fur_corpus() {
  std::vector<std::string> files;
  for (const int keys : {1, 2}) {
    const TemporaryFolder folder;
    const ContentStore store(folder.path());
    FurPageFile::Writer writer(store, {1, 2}, size_t(4) << 10);
    writer.add(small_tree(12, keys, FurNodeLayout::kQuantised));
    writer.add(small_tree(5, keys, FurNodeLayout::kFloat));
    writer.add(small_tree(8, 1, FurNodeLayout::kQuantised, FurRotation::kAlways));
    writer.commit([](const std::string&) {});
    files.push_back(read_file(std::filesystem::directory_iterator(folder.path())->path()));
  }
  return files;
}

std::vector<std::string> treelet_corpus() {
  std::vector<std::string> treelets;
  for (const FurNodeLayout layout : {FurNodeLayout::kQuantised, FurNodeLayout::kFloat}) {
    const bool turned = layout == FurNodeLayout::kQuantised;
    const FurTree tree = small_tree(10, 1, layout, turned ? FurRotation::kAlways : FurRotation::kNever);
    std::string bytes(16, '\0');
    bytes[0] = layout == FurNodeLayout::kQuantised ? '\0' : '\1';
    bytes[4] = turned ? '\1' : '\0';
    bytes[3] = static_cast<char>(tree.node_bytes() / node_size(layout, 1) - 1);
    bytes.append(reinterpret_cast<const char*>(tree.view().nodes), tree.node_bytes());
    bytes.append(reinterpret_cast<const char*>(tree.view().leaves), tree.leaf_bytes());
    treelets.push_back(std::move(bytes));
  }
  return treelets;
}

}  // namespace pelage
