// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/schema.h"
#include "groom/operators/operator.h"

namespace pelage {

/// `operators:` of a groom: a list of maps with one key each, the name of the operator. Holds the operators
/// as the scene describes them, before prepare(). A groom makes its own copies.
struct OperatorList {
  struct Item {
    std::string name;
    SourcePosition position;
    std::shared_ptr<const Operator> prototype;
    std::unique_ptr<Operator> (*clone)(const Operator&) = nullptr;
    bool masked = false;  ///< whether the prototype is a MaskedOperator
  };
  std::vector<Item> items;
};

/// Returns an operator with default parameters. An operator of this name must exist.
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
