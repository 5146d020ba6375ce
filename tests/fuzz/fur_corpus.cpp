// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_tree.h"
#include "tests/fuzz/corpus.h"
#include "tests/render/accel/fur/fur_grooms.h"

namespace pelage {

std::vector<std::string> fur_corpus() {
  std::vector<std::string> trees;
  for (const int keys : {1, 2}) {
    GroomShape shape;
    shape.motion_keys = keys;
    const Strands groom = random_groom(shape, 10, 3);
    FurTreeOptions options;
    options.build.rotation = FurRotation::kAlways;
    const FurTree tree(SnappedStrands(groom, FurGrid(shape.width)), options);
    std::string bytes(16, '\0');
    bytes[1] = static_cast<char>(keys - 1);
    bytes[3] = static_cast<char>(tree.node_bytes() / FurQuantisedNode::size(keys) - 1);
    bytes[4] = tree.view().frame.turned ? '\1' : '\0';
    bytes.append(reinterpret_cast<const char*>(tree.view().nodes), tree.node_bytes());
    bytes.append(reinterpret_cast<const char*>(tree.view().leaves), tree.leaf_bytes());
    trees.push_back(std::move(bytes));
  }
  return trees;
}

}  // namespace pelage
