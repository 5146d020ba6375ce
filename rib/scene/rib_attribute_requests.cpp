// SPDX-License-Identifier: Apache-2.0
// Transforms, attributes and shaders.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "rib/scene/rib_interpreter.h"

namespace pelage {
namespace {

/// All numbers of a request, which may be in an array or not.
std::vector<float> numbers_of(const RibStatement& request, size_t count) {
  std::vector<float> numbers;
  for (const RibOperand& a : request.arguments) {
    if (!a.is_number()) request.fail(a, "expected a number, got " + a.describe());
    for (size_t i = 0; i < a.size() && numbers.size() <= count; ++i) numbers.push_back(a.number(i));
  }
  if (numbers.size() != count)
    request.fail(fmt::format("expected {} numbers, got {}", count, numbers.size()));
  for (const float x : numbers) {
    if (!std::isfinite(x)) request.fail("a number is not finite");
  }
  return numbers;
}

// Exporters write inverses with rounding errors in the last column, and factors of the whole matrix.
void make_affine(const RibStatement& request, M44f& matrix) {
  float largest = 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) largest = std::max(largest, std::abs(matrix[row][column]));
  }
  const float noise = 1e-5f * std::max(largest, std::abs(matrix[3][3]));
  for (int row = 0; row < 3; ++row) {
    if (!(std::abs(matrix[row][3]) <= noise))
      request.fail("the last column of a matrix must be 0 0 0 1; perspective belongs to Projection");
    matrix[row][3] = 0;
  }
  const float factor = matrix[3][3];
  if (!(std::abs(factor) > 1e-30f)) request.fail("the last number of a matrix must not be 0");
  if (std::abs(factor - 1) > 1e-5f) matrix *= 1 / factor;
  matrix[3][3] = 1;
}

M44f matrix_of(const RibStatement& request) {
  M44f matrix;
  if (request.name == "Identity") return matrix;
  if (request.name == "Translate" || request.name == "Scale") {
    const std::vector<float> n = numbers_of(request, 3);
    const V3f v(n[0], n[1], n[2]);
    request.name == "Scale" ? matrix.setScale(v) : matrix.setTranslation(v);
  } else if (request.name == "Rotate") {
    const std::vector<float> n = numbers_of(request, 4);
    const V3f axis(n[1], n[2], n[3]);
    if (axis.length() > 0) matrix.setAxisAngle(axis, n[0] * std::numbers::pi_v<float> / 180);
  } else {
    const std::vector<float> n = numbers_of(request, 16);
    for (size_t i = 0; i < 16; ++i) matrix.x[i / 4][i % 4] = n[i];
    make_affine(request, matrix);
  }
  return matrix;
}

const std::string& text_of(const RibStatement& request, size_t index) {
  if (index >= request.arguments.size() || request.arguments[index].is_number() ||
      request.arguments[index].size() != 1)
    request.fail("expected a name");
  return request.arguments[index].strings[0];
}

}  // namespace

void RibInterpreter::transform(const Call& call) {
  RibTransform own(matrix_of(call.request()));
  if (call.times.size() > 1) {
    std::vector<std::pair<double, M44f>> samples;
    for (size_t i = 0; i < call.samples.size(); ++i)
      samples.emplace_back(call.times[i], matrix_of(call.samples[i]));
    own = RibTransform(std::move(samples));
  }
  now_.to_world = now_.to_world.after(own);
  if (now_.to_world.sample_count() > 1000) call.request().fail("a transform has more than 1000 times");
}

void RibInterpreter::set_transform(const Call& call) {
  now_.to_world = context_.world;
  transform(call);
}

void RibInterpreter::coordinate_system(const Call& call) {
  context_.spaces[text_of(call.request(), 0)] = now_.to_world;
}

void RibInterpreter::use_coordinate_system(const Call& call) {
  const std::string& name = text_of(call.request(), 0);
  if (name == "world") {
    now_.to_world = context_.world;
  } else if (const auto space = context_.spaces.find(name); space != context_.spaces.end()) {
    now_.to_world = space->second;
  } else {
    warn_once("space " + name, call.request().position(),
              "there is no coordinate system " + quote(name) + "; skipped");
  }
}

void RibInterpreter::color(const Call& call) {
  const std::vector<float> n = numbers_of(call.request(), 3);
  now_.color = Rgb(n[0], n[1], n[2]);
  for (int c = 0; c < 3; ++c) now_.color[c] = std::clamp(now_.color[c], 0.0f, 1.0f);
  if (now_.color != Rgb(n[0], n[1], n[2]))
    warn_once("clamped color", call.request().position(), "colours of surfaces are 0 to 1; clamped");
}

void RibInterpreter::opacity(const Call& call) {
  const std::vector<float> n = numbers_of(call.request(), 3);
  now_.opacity = std::clamp((n[0] + n[1] + n[2]) / 3, 0.0f, 1.0f);
}

RibBasis RibInterpreter::basis_of(const RibStatement& request, const RibOperand& v, const RibOperand& step) {
  if (!step.is_number() || step.size() != 1 || !(step.number(0) >= 1 && step.number(0) <= 4))
    request.fail(step, "a step is 1 to 4");
  RibBasis basis;
  if (!v.is_number() && v.size() == 1) {
    const std::optional<RibBasis> named = RibBasis::named(v.strings[0]);
    const std::string known[] = {"bezier", "b-spline", "catmull-rom", "hermite", "power"};
    if (!named) request.fail(v, "unknown basis " + quote(v.strings[0]) + suggest(v.strings[0], known));
    basis = *named;
  } else if (v.is_number() && v.size() == 16) {
    basis.kind = RibBasis::Kind::kOther;
    for (size_t i = 0; i < 16; ++i) basis.matrix.x[i / 4][i % 4] = v.number(i);
    for (const RibBasis::Kind kind : {RibBasis::Kind::kBSpline, RibBasis::Kind::kCatmullRom}) {
      const RibBasis named = *RibBasis::named(kind == RibBasis::Kind::kBSpline ? "b-spline" : "catmull-rom");
      if (basis.matrix.equalWithAbsError(named.matrix, 1e-5f)) basis = named;
    }
  } else {
    request.fail(v, "a basis is a name or 16 numbers, got " + v.describe());
  }
  basis.step = static_cast<int>(step.number(0));
  return basis;
}

void RibInterpreter::basis(const Call& call) {
  const RibStatement& request = call.request();
  const auto& a = request.arguments;
  if (a.size() != 4) request.fail("expected a basis and a step, twice");
  now_.basis_u = basis_of(request, a[0], a[1]);
  now_.basis = basis_of(request, a[2], a[3]);
}

void RibInterpreter::declare(const Call& call) {
  const std::string& type = text_of(call.request(), 1);
  if (!parse_declaration(type)) {
    warn_once("declaration " + type, call.request().position(),
              "Declare: " + quote(type) + " is no class and type that Pelage knows; skipped");
    return;
  }
  context_.declarations.declare(text_of(call.request(), 0), text_of(call.request(), 1), call.request());
}

void RibInterpreter::attribute(const Call& call) {
  RibStatement& request = call.request();
  const std::string kind = text_of(request, 0);
  if (kind != "identifier" && kind != "pelage" && kind != "visibility") {
    warn_once("Attribute " + kind, request.position(),
              "Attribute " + quote(kind) + " is not supported; skipped");
    return;
  }
  for (const RibSetting& setting : settings_of(request, 1)) {
    if (kind == "identifier") {
      if (setting.name == "name" && setting.strings.size() == 1) now_.name = setting.strings[0];
    } else if (kind == "visibility") {
      if (setting.name == "camera" && setting.numbers.size() == 1)
        now_.seen_by_camera = setting.numbers[0] != 0;
    } else if (setting.name == "tint" && setting.numbers.size() == 3) {
      now_.tint = Rgb(setting.numbers[0], setting.numbers[1], setting.numbers[2]);
    } else if (setting.name == "chaikin" && setting.numbers.size() == 1) {
      now_.chaikin_creases = setting.numbers[0] != 0;
    } else if (setting.name == "scheme" && setting.strings.size() == 1) {
      now_.bilinear = setting.strings[0] == "bilinear";
    }
  }
}

std::vector<RibSetting> RibInterpreter::settings_of(RibStatement& request, size_t parameters) {
  std::vector<std::string> undeclared;
  std::vector<RibSetting> settings;
  for (const RibNamedValue& p : context_.declarations.parameters(request, parameters, undeclared)) {
    RibSetting setting{p.name, p.declaration.type, request.position(*p.value), false, {}, {}};
    setting.is_array = p.value->size() > static_cast<size_t>(p.declaration.components) ||
                       (p.declaration.components > 1 && p.declaration.type != "color");
    for (size_t i = 0; i < p.value->size(); ++i) {
      if (p.value->is_number()) {
        setting.numbers.push_back(p.value->number(i));
      } else {
        setting.strings.push_back(p.value->strings[i]);
      }
    }
    settings.push_back(std::move(setting));
  }
  warn_undeclared(request, undeclared);
  return settings;
}

std::shared_ptr<const RibShader> RibInterpreter::shader_of(RibStatement& request, size_t parameters) {
  auto shader = std::make_shared<RibShader>();
  shader->name = text_of(request, 0);
  shader->position = request.position();
  shader->settings = settings_of(request, parameters);
  return shader;
}

void RibInterpreter::surface(const Call& call) { now_.surface = shader_of(call.request(), 1); }

const RibSetting* RibShader::find(std::string_view wanted) const {
  for (const RibSetting& setting : settings) {
    if (setting.name == wanted) return &setting;
  }
  return nullptr;
}

}  // namespace pelage
