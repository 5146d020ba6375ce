// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "image/field_forms.h"
#include "image/field_operations.h"

namespace pelage {
namespace {

struct ProductForm {
  FieldInputs product;
  static const Schema<ProductForm>& schema();
};
struct SumForm {
  FieldInputs add;
  static const Schema<SumForm>& schema();
};
struct MinForm {
  FieldInputs min;
  static const Schema<MinForm>& schema();
};
struct MaxForm {
  FieldInputs max;
  static const Schema<MaxForm>& schema();
};
struct MixForm {
  FieldInputs mix;
  FieldInput by;
  static const Schema<MixForm>& schema();
};
struct InvertForm {
  FieldInput invert;
  static const Schema<InvertForm>& schema();
};
struct ClampForm {
  FieldInput clamp;
  float low = 0;
  float high = 1;
  static const Schema<ClampForm>& schema();
};
struct ThresholdForm {
  FieldInput threshold;
  float at = 0.5f;
  float width = 0;
  static const Schema<ThresholdForm>& schema();
};
struct StepForm {
  FieldInput step;
  float size = 0.25f;
  static const Schema<StepForm>& schema();
};
struct RemapForm {
  FieldInput remap;
  std::vector<RampKnot> knots;
  static const Schema<RemapForm>& schema();
};

const Schema<ProductForm>& ProductForm::schema() {
  static const Schema<ProductForm> table = [] {
    Schema<ProductForm> s("product field", "The product of several fields.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length:
          value:
            product:
              - {ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}
              - {noise: {frequency: 1.2, amplitude: 1.6, offset: 0.6}})");
    s.set_picture("Left: a ramp along x. Right: the same ramp multiplied by noise.");
    s.key("product", &ProductForm::product, {.help = "Fields to multiply", .required = true});
    return s;
  }();
  return table;
}

const Schema<SumForm>& SumForm::schema() {
  static const Schema<SumForm> table = [] {
    Schema<SumForm> s("add field", "The sum of several fields.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {add: [{ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}, {noise: {frequency: 2, amplitude: 0.3}}]}})");
    s.set_picture("Left: a ramp along x. Right: the same ramp with noise added.");
    s.key("add", &SumForm::add, {.help = "Fields to add", .required = true});
    return s;
  }();
  return table;
}

const Schema<MinForm>& MinForm::schema() {
  static const Schema<MinForm> table = [] {
    Schema<MinForm> s("min field", "The smallest of several fields, for colours in each channel.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {min: [{ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}, 0.5]}})");
    s.set_picture("Left: a ramp along x. Right: the same ramp, but at most 0.5.");
    s.key("min", &MinForm::min, {.help = "Fields to compare", .required = true});
    return s;
  }();
  return table;
}

const Schema<MaxForm>& MaxForm::schema() {
  static const Schema<MaxForm> table = [] {
    Schema<MaxForm> s("max field", "The largest of several fields, for colours in each channel.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {max: [{ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}, 0.5]}})");
    s.key("max", &MaxForm::max, {.help = "Fields to compare", .required = true});
    return s;
  }();
  return table;
}

const Schema<MixForm>& MixForm::schema() {
  static const Schema<MixForm> table = [] {
    Schema<MixForm> s("mix field", "A blend of two fields by a third one.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - color: {value: {mix: [[0.05, 0.03, 0.02], [0.8, 0.5, 0.25]], by: {threshold: {noise: {frequency: 1.5}}, at: 0, width: 0.3}}})");
    s.set_picture("Left: one colour. Right: two colours, mixed by noise.");
    s.key("mix", &MixForm::mix, {.help = "Two fields", .required = true});
    s.key(
        "by", &MixForm::by,
        {.help = "Weight of the second field: 0 gives the first field, 1 the second one", .required = true});
    return s;
  }();
  return table;
}

const Schema<InvertForm>& InvertForm::schema() {
  static const Schema<InvertForm> table = [] {
    Schema<InvertForm> s("invert field", "1 minus a field.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {invert: {ramp: {along: x, knots: [[-1.5, 0], [1.5, 1]]}}}})");
    s.key("invert", &InvertForm::invert, {.help = "Field to invert", .required = true});
    return s;
  }();
  return table;
}

const Schema<ClampForm>& ClampForm::schema() {
  static const Schema<ClampForm> table = [] {
    Schema<ClampForm> s("clamp field", "A field limited to a range.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {clamp: {ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}, low: 0.4, high: 0.7}})");
    s.key("clamp", &ClampForm::clamp, {.help = "Field to limit", .required = true});
    s.key("low", &ClampForm::low, {.help = "Lowest value"});
    s.key("high", &ClampForm::high, {.help = "Highest value"});
    return s;
  }();
  return table;
}

const Schema<ThresholdForm>& ThresholdForm::schema() {
  static const Schema<ThresholdForm> table = [] {
    Schema<ThresholdForm> s("threshold field", "0 where a field is small, 1 where it is large.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {threshold: {ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}, at: 0.5, width: 0.1}})");
    s.key("threshold", &ThresholdForm::threshold, {.help = "Field to compare", .required = true});
    s.key("at", &ThresholdForm::at, {.help = "Value from which the result is 1"});
    s.key("width", &ThresholdForm::width,
          {.help = "Width of a smooth transition around this value, in values of the field", .min = 0});
    return s;
  }();
  return table;
}

const Schema<StepForm>& StepForm::schema() {
  static const Schema<StepForm> table = [] {
    Schema<StepForm> s("step field", "A field in steps: rounds down to multiples of a number.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {step: {ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}, size: 0.25}})");
    s.key("step", &StepForm::step, {.help = "Field to round", .required = true});
    s.key("size", &StepForm::size, {.help = "Height of a step", .min = 0, .above_min = true});
    return s;
  }();
  return table;
}

const Schema<RemapForm>& RemapForm::schema() {
  static const Schema<RemapForm> table = [] {
    Schema<RemapForm> s("remap field", "A field through a curve.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {remap: {ramp: {along: x, knots: [[-1.5, 0], [1.5, 1]]}}, knots: [[0, 0.2], [0.5, 1], [1, 0.2]]}})");
    s.key("remap", &RemapForm::remap, {.help = "Field whose values are looked up", .required = true});
    s.key("knots", &RemapForm::knots,
          {.help = "Knots [value of the field, result] by increasing value, linear in between and constant "
                   "outside. Two knots at one value make a step",
           .required = true});
    return s;
  }();
  return table;
}

template <class Form>
bool read_inputs(const Value& value, const char* key, Form& form, FieldInputs Form::*inputs,
                 Problems& problems) {
  if (!Form::schema().read(value, form, problems)) return false;
  if (!(form.*inputs).list.empty()) return true;
  const bool product = std::string_view(key) == "product";
  problems.add(value.find(key)->position(), product ? "a product needs at least 1 factor"
                                                    : fmt::format("`{}` needs at least 1 field", key));
  return false;
}

bool read_product(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  ProductForm form;
  if (!read_inputs(value, "product", form, &ProductForm::product, problems)) return false;
  out = product_field(std::move(form.product.list));
  return true;
}

bool read_sum(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  SumForm form;
  if (!read_inputs(value, "add", form, &SumForm::add, problems)) return false;
  out = sum_field(std::move(form.add.list));
  return true;
}

bool read_min(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  MinForm form;
  if (!read_inputs(value, "min", form, &MinForm::min, problems)) return false;
  out = min_field(std::move(form.min.list));
  return true;
}

bool read_max(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  MaxForm form;
  if (!read_inputs(value, "max", form, &MaxForm::max, problems)) return false;
  out = max_field(std::move(form.max.list));
  return true;
}

bool read_mix(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  MixForm form;
  if (!MixForm::schema().read(value, form, problems)) return false;
  if (form.mix.list.size() != 2) {
    problems.add(value.find("mix")->position(),
                 fmt::format("`mix` needs 2 fields, got {}", form.mix.list.size()));
    return false;
  }
  out = mix_field(form.mix.list[0], form.mix.list[1], form.by.field);
  return true;
}

bool read_invert(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  InvertForm form;
  if (!InvertForm::schema().read(value, form, problems)) return false;
  out = inverted_field(form.invert.field);
  return true;
}

bool read_clamp(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  ClampForm form;
  if (!ClampForm::schema().read(value, form, problems)) return false;
  if (form.low > form.high) {
    problems.add(value.position(), fmt::format("`low` is above `high`: {} > {}", form.low, form.high));
    return false;
  }
  out = clamp_block_field(form.clamp.field, form.low, form.high);
  return true;
}

bool read_threshold(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  ThresholdForm form;
  if (!ThresholdForm::schema().read(value, form, problems)) return false;
  out = threshold_field(form.threshold.field, form.at, form.width);
  return true;
}

bool read_step(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  StepForm form;
  if (!StepForm::schema().read(value, form, problems)) return false;
  out = step_field(form.step.field, form.size);
  return true;
}

bool read_remap(const Value& value, const KeyOptions& limits, Field& out, Problems& problems) {
  RemapForm form;
  if (!RemapForm::schema().read(value, form, problems)) return false;
  if (!check_knots(form.knots, *value.find("knots"), limits, problems)) return false;
  out = remapped_field(form.remap.field, std::move(form.knots));
  return true;
}

constexpr FieldForm kOperationForms[] = {{"product", read_product, form_table<ProductForm>},
                                         {"add", read_sum, form_table<SumForm>},
                                         {"min", read_min, form_table<MinForm>},
                                         {"max", read_max, form_table<MaxForm>},
                                         {"mix", read_mix, form_table<MixForm>},
                                         {"invert", read_invert, form_table<InvertForm>},
                                         {"clamp", read_clamp, form_table<ClampForm>},
                                         {"threshold", read_threshold, form_table<ThresholdForm>},
                                         {"step", read_step, form_table<StepForm>},
                                         {"remap", read_remap, form_table<RemapForm>}};

}  // namespace

std::span<const FieldForm> operation_field_forms() { return kOperationForms; }

}  // namespace pelage
