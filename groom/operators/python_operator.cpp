// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/python_operator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <fmt/format.h>

#include "base/check.h"
#include "base/place_of_file.h"
#include "groom/operators/operator_scripts.h"
#include "groom/operators/script_batch.h"

namespace pelage {
namespace {

/// What a function may exceed its limits by: 1,000 times the rounding of a float.
constexpr float kSlack = 1.0001f;

V3f point_of(const std::vector<float>& positions, size_t i) {
  return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
}

/// Names a strand in messages. The centres of clumps are strands, too, and their ids have the highest bit.
std::string name_of(uint64_t id) {
  constexpr uint64_t kCentre = uint64_t(1) << 63;
  return id & kCentre ? fmt::format("the clump centre {}", id & ~kCentre) : fmt::format("strand {}", id);
}

/// Indices of every fourth strand of a batch, in reverse order; of few strands, each of them twice.
std::vector<size_t> other_batch(const StrandBatch& batch) {
  std::vector<size_t> strands;
  if (batch.count < 8) {
    for (size_t s = 0; s < 2 * batch.count; ++s) strands.push_back(s % batch.count);
  } else {
    for (size_t s = batch.ids[0] % 4; s < batch.count; s += 4) strands.push_back(s);
  }
  std::reverse(strands.begin(), strands.end());
  return strands;
}

/// Whether a strand of one batch has the values of a strand of another, bit for bit.
bool same_values(const std::vector<float>& a, size_t i, const std::vector<float>& b, size_t j,
                 size_t floats) {
  return floats == 0 || std::memcmp(&a[i * floats], &b[j * floats], floats * sizeof(float)) == 0;
}

}  // namespace

const Schema<PythonOperatorParams>& PythonOperatorParams::schema() {
  static const Schema<PythonOperatorParams> table = [] {
    Schema<PythonOperatorParams> s(
        "python",
        "Shapes strands with a function in Python, which gets many strands at a time as numpy arrays and "
        "returns moved "
        "points, widths or colours (docs/PYTHON.md). Such a function may do whatever the user may do; so "
        "Pelage only "
        "runs it with the flag `--allow-scripts`. The result for a strand must depend on this strand alone.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: 0.5}
      - python: {module: sway.py, function: sway, bound: 0.2, arguments: {amount: 0.1}})");
    s.key("module", &PythonOperatorParams::module,
          {.help = "Python file with the function", .required = true});
    s.key("function", &PythonOperatorParams::function, {.help = "Name of the function", .required = true});
    s.key("bound", &PythonOperatorParams::bound,
          {.unit = "scene units",
           .help = "Max distance by which the function moves a point; an error if it moves one farther",
           .required = true,
           .min = 0});
    s.key(
        "max_width", &PythonOperatorParams::max_width,
        {.unit = "scene units",
         .help =
             "Max width that the function gives to points; without it, the function must not make any wider",
         .min = 0});
    s.key("colors", &PythonOperatorParams::colors,
          {.help = "Whether the function returns colours: one for each strand, or one for each point"});
    s.key("space", &PythonOperatorParams::space,
          {.help = "Whether the function sees strands at rest, or, at each motion key, in the pose of the "
                   "frame. After "
                   "an operator that reads the pose, it is the pose in any case"});
    s.key("arguments", &PythonOperatorParams::arguments, {.help = "Keyword arguments of the function"});
    return s;
  }();
  return table;
}

OperatorTraits PythonOperator::traits() const {
  OperatorTraits traits{.name = kName};
  traits.reads_rest_only = params_.space == ScriptSpace::kRest;
  traits.has_one_width_profile = false;
  traits.runs_script = true;
  if (params_.colors != ScriptColors::kNone) {
    traits.colors =
        params_.colors == ScriptColors::kPoint ? AttributeClass::kPerPoint : AttributeClass::kPerStrand;
    traits.colors_partly = true;
  }
  return traits;
}

void PythonOperator::prepare(const PrepareContext& context) {
  PELAGE_CHECK(context.scripts);  // Groom::create() has refused the groom otherwise
  position_ = context.position;
  owner_ = context.owner;
  seed_ = context.seed;
  script_ = with_place_of(params_.module, [&] {
    return context.scripts->open({params_.module.path, params_.function, params_.arguments.json},
                                 context.job);
  });
}

void PythonOperator::fail(uint64_t strand, const std::string& what) const {
  throw Error(ErrorKind::kInput, position_,
              fmt::format("'python' {}() {} {} of {}", params_.function, what, name_of(strand), owner_));
}

/// Calls the function. If it fails, looks for a strand for which it fails alone.
void PythonOperator::run(ScriptBatch& strands, const StrandBatch& batch) const {
  const auto call = [&](ScriptBatch& on, PelageScriptFault& fault) {
    PelageScriptBatch view = on.view();
    view.seed = seed_;
    view.writes_colors = params_.colors != ScriptColors::kNone;
    return script_->run(view, fault);
  };
  PelageScriptFault fault{};
  if (call(strands, fault)) return;
  std::string where = fmt::format("{} strands", strands.strands);
  for (size_t s = 0; s < batch.count; ++s) {
    PelageScriptFault own{};
    ScriptBatch one(batch, std::span(&s, 1));
    if (call(one, own)) continue;
    fault = own;
    where = name_of(batch.ids[s]);
    break;
  }
  const bool in_script = fault.line > 0;
  throw Error(ErrorKind::kInput,
              in_script ? SourcePosition{params_.module.path.string(), fault.line, 0} : position_,
              fmt::format("{}, in {}() for {} of {}", fault.message, params_.function, where, owner_));
}

void PythonOperator::check_limits(const ScriptBatch& strands) const {
  const float far = params_.bound * strands.scale * kSlack;
  const float wide = params_.max_width.value_or(0) * strands.scale * kSlack;
  for (size_t s = 0, i = 0; s < strands.strands; ++s) {
    for (size_t p = 0; p < strands.points; ++p, ++i) {
      const V3f before = point_of(strands.positions, i), after = point_of(strands.new_positions, i);
      const float moved = (after - before).length(), width = strands.new_widths[i];
      if (!std::isfinite(moved) || !std::isfinite(width))
        fail(strands.ids[s], "returns a number that is not finite for");
      if (p == 0 && after != before) fail(strands.ids[s], "moves point 0, the root, of");
      if (moved > far) {
        fail(strands.ids[s], fmt::format("moves point {} by {:.4g}, farther than `bound: {:g}`, of", p,
                                         moved / strands.scale, params_.bound));
      }
      if (width < 0) fail(strands.ids[s], "returns a negative width for");
      if (width > std::max(wide, strands.widths[i])) {
        fail(strands.ids[s], fmt::format("makes point {} {:.4g} wide, more than `max_width` allows, of", p,
                                         width / strands.scale));
      }
    }
    for (size_t c = 3 * s * strands.color_rows; c < 3 * (s + 1) * strands.color_rows; ++c) {
      if (!(strands.new_colors[c] >= 0 && std::isfinite(strands.new_colors[c])))
        fail(strands.ids[s], "returns a colour that is negative or not finite for");
    }
  }
}

void PythonOperator::check_alone(const ScriptBatch& strands, const StrandBatch& batch) const {
  const std::vector<size_t> indices = other_batch(batch);
  ScriptBatch others(batch, indices);
  run(others, batch);
  for (size_t i = 0; i < indices.size(); ++i) {
    const size_t s = indices[i], points = strands.points;
    if (same_values(strands.new_positions, s, others.new_positions, i, 3 * points) &&
        same_values(strands.new_widths, s, others.new_widths, i, points) &&
        same_values(strands.new_colors, s, others.new_colors, i, 3 * strands.color_rows)) {
      continue;
    }
    fail(strands.ids[s], fmt::format("must treat each strand alone, but its result depends on the {} other "
                                     "strands that it gets, or is "
                                     "random, for",
                                     strands.strands - 1));
  }
}

void PythonOperator::apply(StrandBatch& batch) const {
  std::vector<size_t> all(batch.count);
  std::iota(all.begin(), all.end(), size_t(0));
  ScriptBatch strands(batch, all);
  run(strands, batch);
  check_limits(strands);
  check_alone(strands, batch);
  strands.write(batch);
}

StrandReach PythonOperator::reach_after(const StrandReach& before) const {
  StrandReach after = before.displaced(params_.bound * kSlack);
  after.radius = std::max(before.radius, params_.max_width.value_or(0) / 2 * kSlack);
  return after;
}

}  // namespace pelage
