// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/python_operator.h"

#include <functional>
#include <limits>

#include "groom/groom.h"
#include "groom/operators/operator_scripts.h"
#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"

namespace pelage::python_operator_test {
namespace {

using Function = std::function<bool(const PelageScriptBatch&, PelageScriptFault&)>;

/// A function of C++ in place of one of Python.
class PlainScripts final : public OperatorScripts {
 public:
  explicit PlainScripts(Function function) : function_(std::move(function)) {}
  std::shared_ptr<const StrandScript> open(const ScriptSource&, const Job&) const override {
    struct Plain final : StrandScript {
      explicit Plain(Function f) : function(std::move(f)) {}
      bool run(const PelageScriptBatch& batch, PelageScriptFault& fault) const override {
        return function(batch, fault);
      }
      Function function;
    };
    return std::make_shared<Plain>(function_);
  }

 private:
  Function function_;
};

/// Scales offsets from the root so that a point moves by `distance`, in scene units.
Function outwards(float distance) {
  return [distance](const PelageScriptBatch& b, PelageScriptFault&) {
    for (size_t i = 0; i < b.strands * b.points; ++i) {
      const float* p = b.positions + 3 * i;
      const float length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
      for (size_t c = 0; c < 3 && length > 0; ++c)
        b.new_positions[3 * i + c] = p[c] * (1 + distance * b.scale / length);
    }
    return true;
  };
}

/// Sets one value of the strand with the id 17: its point 2.
Function at_strand_17(const std::function<void(const PelageScriptBatch&, size_t point)>& set) {
  return [set](const PelageScriptBatch& b, PelageScriptFault&) {
    for (size_t s = 0; s < b.strands; ++s) {
      if (b.ids[s] == 17) set(b, s * b.points + 2);
    }
    return true;
  };
}

class PythonOperatorTest : public OperatorTest {
 protected:
  PythonOperator made(const Function& function, PythonOperatorParams params = {}) {
    params.module.path = "sway.py";
    params.function = "sway";
    if (params.bound == 0) params.bound = 0.2f;
    PythonOperator op(std::move(params));
    const PlainScripts scripts(function);
    PrepareContext with = context();
    with.scripts = &scripts;
    with.position = {"scene.yaml", 7, 9};
    op.prepare(with);
    return op;
  }

  /// The batch that holds the strand with the id 17, with its colours.
  std::unique_ptr<StrandBatch> of_strand_17(size_t color_rows = 0) const {
    for (size_t first = 0;; first += kBlockStrands) {
      auto batch = straight(first);
      if (std::find(batch->ids.begin(), batch->ids.begin() + static_cast<long>(batch->count), 17) ==
          batch->ids.begin() + static_cast<long>(batch->count))
        continue;
      batch->colors.resize(color_rows);
      clear_attributes(*batch);
      return batch;
    }
  }

  std::string error_of(const PythonOperator& op, size_t color_rows = 0) const {
    auto batch = of_strand_17(color_rows);
    try {
      op.apply(*batch);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      return error.what();
    }
    return "";
  }
};

TEST_F(PythonOperatorTest, Bounds) {
  check_bounds(made(outwards(0.2f)), {1.5f, 1.5f, 0});
  PythonOperatorParams params;
  params.bound = 0.01f;
  params.max_width = 0.5f;
  const Function widen = [](const PelageScriptBatch& b, PelageScriptFault&) {
    std::fill_n(b.new_widths, b.strands * b.points, 0.5f);
    return true;
  };
  check_bounds(made(widen, params), {1.5f, 1.5f, 0.1f});
}

TEST_F(PythonOperatorTest, BoundsGrowWithTheCharacter) {
  const PythonOperator op = made(outwards(0.2f));
  auto batch = straight();
  batch->scale = 10;
  op.apply(*batch);
  EXPECT_NEAR(length_of(*batch, 5), 3, 1e-4f);  // 1 in scene units of the batch, moved by 0.2 x 10
}

TEST_F(PythonOperatorTest, WhatIsOutOfBoundsNamesItsStrand) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string where = "scene.yaml:7:9: 'python' sway() ", whose = " strand 17 of groom 'coat'";
  const auto moves = [](float x) {
    return at_strand_17([x](const PelageScriptBatch& b, size_t p) { b.new_positions[3 * p] += x; });
  };
  EXPECT_EQ(error_of(made(moves(0.1f))), "");
  EXPECT_EQ(error_of(made(moves(0.3f))),
            where + "moves point 2 by 0.3, farther than `bound: 0.2`, of" + whose);
  EXPECT_EQ(error_of(made(moves(nan))), where + "returns a number that is not finite for" + whose);
  EXPECT_EQ(error_of(made(at_strand_17(
                [](const PelageScriptBatch& b, size_t p) { b.new_positions[3 * (p - 2)] += 0.01f; }))),
            where + "moves point 0, the root, of" + whose);
  EXPECT_EQ(
      error_of(made(at_strand_17([](const PelageScriptBatch& b, size_t p) { b.new_widths[p] = 0.1f; }))),
      where + "makes point 2 0.1 wide, more than `max_width` allows, of" + whose);
  EXPECT_EQ(
      error_of(made(at_strand_17([](const PelageScriptBatch& b, size_t p) { b.new_widths[p] = -0.1f; }))),
      where + "returns a negative width for" + whose);
  const Function dark =
      at_strand_17([](const PelageScriptBatch& b, size_t p) { b.new_colors[p / b.points * 3] = -1; });
  EXPECT_EQ(error_of(made(dark), 1), where + "returns a colour that is negative or not finite for" + whose);
}

TEST_F(PythonOperatorTest, StrandsMayNotDependOnOthers) {
  const auto shift = [](const std::function<float(const PelageScriptBatch&)>& by) -> Function {
    return [by](const PelageScriptBatch& b, PelageScriptFault&) {
      const float x = by(b);
      for (size_t s = 0; s < b.strands; ++s) b.new_positions[3 * (s * b.points + 1)] += x;
      return true;
    };
  };
  EXPECT_EQ(error_of(made(shift([](const auto&) { return 0.01f; }))), "");
  int calls = 0;
  for (const Function& function : {shift([](const auto& b) { return 1e-5f * static_cast<float>(b.strands); }),
                                   shift([](const auto& b) { return 1e-9f * static_cast<float>(b.ids[0]); }),
                                   shift([&](const auto&) { return 0.01f * static_cast<float>(++calls); })}) {
    EXPECT_NE(error_of(made(function))
                  .find("must treat each strand alone, but its result depends on the 255 other"),
              std::string::npos);
    auto few = straight(0, 8, 3);
    EXPECT_THROW(made(function).apply(*few), Error);
  }
}

TEST_F(PythonOperatorTest, AFaultNamesTheStrandAndTheLine) {
  const auto fails = [](bool alone) -> Function {
    return [alone](const PelageScriptBatch& b, PelageScriptFault& fault) {
      if (!alone && b.strands == 1) return true;
      if (std::find(b.ids, b.ids + b.strands, 17) == b.ids + b.strands) return true;
      fault.line = 12;
      std::snprintf(fault.message, sizeof fault.message, "ZeroDivisionError: division by zero");
      return false;
    };
  };
  EXPECT_EQ(error_of(made(fails(true))),
            "sway.py:12: ZeroDivisionError: division by zero, in sway() for strand 17 of groom 'coat'");
  EXPECT_EQ(error_of(made(fails(false))),
            "sway.py:12: ZeroDivisionError: division by zero, in sway() for 256 strands of groom 'coat'");
}

TEST_F(PythonOperatorTest, AGroomRefusesScriptsThatTheUserHasNotAllowed) {
  const auto params = scene_text::read<GroomParams>(
      "skin: rat\nstrands: 10\noperators:\n  - length: {value: 1}\n"
      "  - python: {module: sway.py, function: sway, bound: 0.1, mask: 0.5}\n");
  int opened = 0;
  const Function count = [&](const PelageScriptBatch&, PelageScriptFault&) { return ++opened > 0; };
  try {
    Groom::create("coat", params, rest_, textures_, job_);
    FAIL() << "ran a script";
  } catch (const Error& error) {
    EXPECT_EQ(error.problems().front().position.line, 6);
    EXPECT_NE(error.problems().front().message.find("--allow-scripts"), std::string::npos);
  }
  const PlainScripts scripts(count);
  const auto groom = Groom::create("coat", params, rest_, textures_, job_, nullptr, nullptr, &scripts);
  PosedSkin pose;
  pose.keys = {rest_.get(), 1};
  EXPECT_EQ(groom->grow(0, pose).strand_count(), 10u);
  EXPECT_EQ(opened, 2);  // all strands, and some of them in another order
}

TEST_F(PythonOperatorTest, AMissingModuleHasTheSceneSPosition) {
  class NoFile final : public OperatorScripts {
    std::shared_ptr<const StrandScript> open(const ScriptSource& source, const Job&) const override {
      throw Error(ErrorKind::kInput, {source.file.string(), 0, 0}, "cannot read");
    }
  };
  const auto params = scene_text::read<GroomParams>(
      "skin: rat\nstrands: 10\noperators:\n  - python: {module: nope.py, function: sway, bound: 0.1}\n");
  const NoFile scripts;
  try {
    Groom::create("coat", params, rest_, textures_, job_, nullptr, nullptr, &scripts);
    FAIL() << "found a script";
  } catch (const Error& error) {
    EXPECT_EQ(error.problems().front().position.line, 5);  // the helper adds a line above
    EXPECT_NE(error.problems().front().message.find("nope.py: cannot read"), std::string::npos);
  }
}

TEST(ScriptArgumentsTest, BlocksBecomeJson) {
  const auto json = [](const std::string& text) {
    return scene_text::read<PythonOperatorParams>("module: a.py\nfunction: f\nbound: 1\narguments: " + text +
                                                  "\n")
        .arguments.json;
  };
  EXPECT_EQ(json("{a: 1, b: 0.1, c: [true, null, [], {}], d: \"1\", e: up}"),
            R"({"a": 1, "b": 0.10000000000000001, "c": [true, null, [], {}], "d": "1", "e": "up"})");
  EXPECT_EQ(json(R"({a: "\"\\\n"})"), R"({"a": "\"\\\u000a"})");
  EXPECT_EQ(
      json("{a: 2.0, b: 1e3, c: -0.0, d: 1e300, e: 7, f: True, g: inf}"),
      R"({"a": 2.0, "b": 1000.0, "c": -0.0, "d": 1.0000000000000001e+300, "e": 7, "f": true, "g": "inf"})");
  Problems infinite;
  scene_text::read<PythonOperatorParams>(
      "module: a.py\nfunction: f\nbound: 1\narguments: {a: .nan, b: [-.inf], c: 1e999}\n", infinite);
  ASSERT_EQ(infinite.list().size(), 3u);
  EXPECT_EQ(infinite.list()[1].message, "expected a finite number, got -.inf");
  Problems problems;
  scene_text::read<PythonOperatorParams>("module: a.py\nfunction: f\nbound: 1\narguments: {a b: 1}\n",
                                         problems);
  ASSERT_EQ(problems.list().size(), 1u);
  EXPECT_EQ(problems.list()[0].message, "expected the name of an argument, got 'a b'");
}

}  // namespace
}  // namespace pelage::python_operator_test
