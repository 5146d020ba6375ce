// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/operator_stack.h"

#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"

namespace pelage {
namespace {

using OperatorStackTest = OperatorTest;

TEST_F(OperatorStackTest, AnUnknownAttributeIsNamedAtItsOperatorWithTheNearest) {
  for (const char* root :
       {"{attribute: randon}", "{product: [2, {attribute: random}, {attribute: randon}]}"}) {
    OperatorStack stack(
        scene_text::read<OperatorList>("- color:\n- width: {root: " + std::string(root) + "}\n"));
    try {
      stack.prepare_all(context());
      ADD_FAILURE() << root;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what())
                    .find("'width' reads the unknown attribute 'randon'; did you mean 'random'?"),
                std::string::npos)
          << error.what();
      EXPECT_EQ(error.problems().front().position.line, 3);
    }
  }
}

}  // namespace
}  // namespace pelage
