// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/schema.h"
#include "groom/operator.h"

namespace pelage {

/// `operators:` of a groom: a list of maps with one key each, the operator's name. Holds the operators as
/// described by the scene, before prepare(); grooms copy what they need.
struct OperatorList {
  struct Item {
    std::string name;
    SourcePosition position;
    std::shared_ptr<const Operator> prototype;
    std::unique_ptr<Operator> (*clone)(const Operator&) = nullptr;
  };
  std::vector<Item> items;
};

/// An operator with default parameters; `name` must exist.
OperatorList::Item default_operator(std::string_view name);

template <>
struct ValueReader<OperatorList> {
  static bool read(const Value&, const KeyOptions&, OperatorList& out, Problems&);
  static std::string type_name() { return "list of operators"; }
  static std::string print(const OperatorList&) { return "[]"; }
  static std::vector<const SchemaInfo*> blocks();
  static void visit_blocks(Value& value, const BlockVisitor& visit);
};

}  // namespace pelage
