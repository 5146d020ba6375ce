// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

namespace pelage {

/// Data in the memory of a host program, in a scene in place of a file: a mesh or strands
/// (geom/io/host_geometry.h). Immutable.
class HostData {
 public:
  virtual ~HostData() = default;
  /// Kind and hash of the contents: "mesh:0123...". Data with the same name has the same contents.
  const std::string& name() const { return name_; }

 protected:
  explicit HostData(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

}  // namespace pelage
