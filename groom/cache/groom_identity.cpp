// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/groom_identity.h"

#include "base/error.h"
#include "base/file.h"
#include "base/program_identity.h"
#include "geom/limit_surface.h"
#include "geom/usd/usd_files.h"
#include "image/field_skin.h"

namespace pelage {
namespace {

/// Of a file of USD, also the contents of the files that it names.
std::string hash_of_file(const std::filesystem::path& file) {
  try {
    const std::vector<std::filesystem::path> files = with_usd_files({file});
    if (files.size() == 1) return to_string(file_hash(file));
    ContentHasher hasher;
    for (const std::filesystem::path& one : files) hasher.add(to_string(file_hash(one)));
    return to_string(hasher.digest());
  } catch (const Error&) {
    return "missing";
  }
}

template <class T>
void describe(const T& value, const char* key, std::vector<ParameterText>& out) {
  detail::describe_value(value, key, out);
}

/// The parameters and the version of an operator, as inputs of a stage before it.
void add_operator(const Operator& op, std::vector<ParameterText>& inputs) {
  const std::string name(op.traits().name);
  for (ParameterText& parameter : op.parameters()) {
    parameter.key = name + "." + parameter.key;
    inputs.push_back(std::move(parameter));
  }
  inputs.push_back({name + ".version", std::to_string(op.traits().version)});
}

}  // namespace

GroomIdentity::GroomIdentity(const GroomParams& params, uint64_t seed, const OperatorStack& stack,
                             const LimitSurface* rest, const FieldSkin* skin)
    : skin_(skin) {
  add("skin", growth_version::kSkin,
      {{"fields", std::to_string(growth_version::kFields)},
       {"machine", arithmetic_identity()},
       {"mesh", rest ? to_string(rest->hash()) : "none"}});

  std::vector<ParameterText> strands;
  strands.push_back({"seed", std::to_string(seed)});
  describe(params.strands, "strands", strands);
  describe(params.density, "density", strands);
  describe(params.strands_file, "strands_file", strands);
  describe(params.basis, "basis", strands);
  describe(params.default_width, "default_width", strands);
  if (params.transform) {
    const M44f matrix = params.to_rest();
    strands.push_back({"transform", to_string(content_hash(std::as_bytes(std::span(&matrix[0][0], 16))))});
  }
  // `rest` is null for strands that follow no skin.
  describe(params.attach, "attach", strands);
  for (const auto& op : stack.operators()) {
    if (op->traits().restricts_coverage) add_operator(*op, strands);
  }
  add("strands", growth_version::kStrands, strands);
  // An operator that parts hair also changes what the operators before it do.
  std::vector<ParameterText> points{{"points", std::to_string(params.points)}};
  for (const auto& op : stack.operators()) {
    if (op->traits().parts_hair) add_operator(*op, points);
  }
  add("points", growth_version::kPoints, points);
  for (const auto& op : stack.operators()) {
    const OperatorTraits traits = op->traits();
    add(std::string(traits.name), traits.version, op->parameters());
  }
}

void GroomIdentity::add(std::string name, int version, const std::vector<ParameterText>& parameters) {
  GroomStage stage{std::move(name), {{"version", std::to_string(version)}}, {}};
  for (const ParameterText& parameter : parameters) {
    std::string text = parameter.text;
    // A file is identified by its contents: its path does not affect the result.
    for (const std::filesystem::path& file : parameter.files) {
      const std::string path = file.string(), shown = file.filename().string();
      for (size_t at = text.find(path); at != std::string::npos; at = text.find(path, at + shown.size()))
        text.replace(at, path.size(), shown);
    }
    const bool reads_mesh =
        text.find("{vertex_color: ") != std::string::npos || text.find("{group: ") != std::string::npos;
    if (reads_mesh && skin_)
      stage.inputs.emplace_back("colours and groups of the mesh", to_string(skin_->attributes_hash()));
    stage.inputs.emplace_back(parameter.key, std::move(text));
    for (const std::filesystem::path& file : parameter.files)
      stage.inputs.emplace_back("contents of " + file.filename().string(), hash_of_file(file));
  }
  ContentHasher hasher;
  if (!stages_.empty()) hasher.add(stages_.back().hash);
  hasher.add(stage.name).add(static_cast<uint64_t>(stage.inputs.size()));
  for (const auto& [key, text] : stage.inputs) hasher.add(key).add(text);
  stage.hash = hasher.digest();
  stages_.push_back(std::move(stage));
}

}  // namespace pelage
