// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <pybind11/stl.h>

#include "python/bindings.h"
#include "world/scene_schema.h"

namespace py = pybind11;

namespace pelage {
namespace {

py::object limit(double value) {
  return std::isfinite(value) ? py::object(py::float_(value)) : py::object(py::none());
}

py::dict key_dict(const KeyInfo& key) {
  py::dict entry;
  entry["name"] = key.name;
  entry["type"] = key.type;
  entry["default"] = key.default_text;
  entry["unit"] = std::string(key.options.unit);
  entry["help"] = std::string(key.options.help);
  entry["required"] = key.options.required;
  entry["min"] = limit(key.options.min);
  entry["max"] = limit(key.options.max);
  entry["above_min"] = key.options.above_min;
  py::list blocks;
  for (const SchemaInfo* block : key.blocks) blocks.append(block->name());
  entry["blocks"] = blocks;
  return entry;
}

void add_block(const SchemaInfo& schema, py::dict& blocks) {
  if (blocks.contains(schema.name())) return;
  py::dict block;
  block["name"] = schema.name();
  block["help"] = schema.help();
  block["example"] = schema.example();
  py::list keys;
  for (const KeyInfo& key : schema.keys()) keys.append(key_dict(key));
  block["keys"] = keys;
  blocks[py::str(schema.name())] = block;
  for (const KeyInfo& key : schema.keys()) {
    for (const SchemaInfo* inner : key.blocks) add_block(*inner, blocks);
  }
}

}  // namespace

void bind_schema(py::module_& module) {
  module.def("schema", [] {
    py::dict blocks;
    add_block(SceneDescription::schema(), blocks);
    return blocks;
  });
}

}  // namespace pelage
