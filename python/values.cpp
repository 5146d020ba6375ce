// SPDX-License-Identifier: Apache-2.0
#include "python/values.h"

#include <memory>

#include "geom/io/host_geometry.h"
#include "image/host_image.h"

namespace py = pybind11;

namespace pelage {
namespace {

constexpr int kMaxDepth = 64;

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

}  // namespace

Value to_value(py::handle object, const std::string& path, int depth) {
  const SourcePosition position{path, 0, 0};
  if (depth > kMaxDepth) throw py::type_error(path + ": nested more than 64 levels deep");
  if (object.is_none()) {
    Value null;
    null.set_position(position);
    return null;
  }
  if (py::isinstance<py::str>(object)) return Value::scalar(position, object.cast<std::string>());
  if (py::isinstance<HostMesh>(object))
    return Value::host(position, object.cast<std::shared_ptr<HostMesh>>());
  if (py::isinstance<HostPoses>(object))
    return Value::host(position, object.cast<std::shared_ptr<HostPoses>>());
  if (py::isinstance<HostImage>(object))
    return Value::host(position, object.cast<std::shared_ptr<HostImage>>());
  if (py::isinstance<HostStrands>(object))
    return Value::host(position, object.cast<std::shared_ptr<HostStrands>>());
  if (py::isinstance<py::list>(object)) {
    std::vector<Value> items;
    for (const py::handle item : py::reinterpret_borrow<py::list>(object))
      items.push_back(to_value(item, joined(path, std::to_string(items.size())), depth + 1));
    return Value::list(position, std::move(items));
  }
  if (py::isinstance<py::dict>(object)) {
    std::vector<Value::Entry> entries;
    for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(object)) {
      const auto name = key.cast<std::string>();
      const std::string inner = joined(path, name);
      entries.push_back({name, {inner, 0, 0}, to_value(value, inner, depth + 1)});
    }
    return Value::map(position, std::move(entries));
  }
  throw py::type_error(path + ": cannot be a value of a scene");
}

std::vector<Override> to_overrides(const py::dict& changes) {
  std::vector<Override> overrides;
  for (const auto& [key, value] : changes) {
    const auto name = key.cast<std::string>();
    overrides.push_back({name, "", to_value(value, name)});
  }
  return overrides;
}

}  // namespace pelage
