// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/operator_list.h"

#include <algorithm>

#include "base/check.h"
#include "base/nearest_name.h"
#include "groom/operators/avoid.h"
#include "groom/operators/bend.h"
#include "groom/operators/braid.h"
#include "groom/operators/clump.h"
#include "groom/operators/color.h"
#include "groom/operators/comb.h"
#include "groom/operators/curl.h"
#include "groom/operators/frizz.h"
#include "groom/operators/guides.h"
#include "groom/operators/length.h"
#include "groom/operators/masked_operator.h"
#include "groom/operators/noise.h"
#include "groom/operators/parting.h"
#include "groom/operators/push_out.h"
#include "groom/operators/python_operator.h"
#include "groom/operators/swirl.h"
#include "groom/operators/wet.h"
#include "groom/operators/width.h"

namespace pelage {
namespace {

constexpr std::string_view kMaskKey = "mask", kAmountKey = "amount";

/// Data that the reader needs about each operator.
struct OperatorKind {
  const char* name;
  /// `also`: a key of another table that messages about unknown keys may suggest.
  std::shared_ptr<const Operator> (*read)(const Value&, std::string_view also, Problems&);
  std::unique_ptr<Operator> (*clone)(const Operator&);
  const SchemaInfo& (*schema)();
};

template <class Op>
OperatorKind kind_of() {
  return {
      Op::kName,
      [](const Value& value, std::string_view also, Problems& problems) -> std::shared_ptr<const Operator> {
        typename Op::Params params;
        // `- color:` with nothing behind it means the defaults.
        if (!value.is_null() && !Op::Params::schema().read(value, params, problems, also)) return nullptr;
        return std::make_shared<Op>(std::move(params));
      },
      [](const Operator& prototype) -> std::unique_ptr<Operator> {
        return std::make_unique<Op>(static_cast<const Op&>(prototype));
      },
      []() -> const SchemaInfo& { return Op::Params::schema(); }};
}

const std::vector<OperatorKind>& kinds() {
  static const std::vector<OperatorKind> table{
      kind_of<Length>(), kind_of<Comb>(),          kind_of<Parting>(), kind_of<Swirl>(),   kind_of<Bend>(),
      kind_of<Clump>(),  kind_of<Wet>(),           kind_of<Braid>(),   kind_of<Avoid>(),   kind_of<Curl>(),
      kind_of<Frizz>(),  kind_of<Noise>(),         kind_of<Guides>(),  kind_of<PushOut>(), kind_of<Width>(),
      kind_of<Color>(),  kind_of<PythonOperator>()};
  return table;
}

/// The table of the keys that an operator has beside its own.
const Schema<MaskParams>& mask_table(const OperatorKind& kind) {
  return kind.schema().find(kAmountKey) ? MaskParams::mask_only() : MaskParams::schema();
}

/// The key of mask_table() that is nearest to an unknown key of a block.
std::string_view suggested_key(const Value& block, const OperatorKind& kind) {
  for (const Value::Entry& entry : block.entries()) {
    if (kind.schema().find(entry.key)) continue;
    const std::vector<std::string> names = mask_table(kind).key_names();
    if (nearest_name(entry.key, names) == kAmountKey) return kAmountKey;
  }
  return kMaskKey;
}

bool read_item(const Value& value, OperatorList::Item& item, Problems& problems) {
  if (!value.is_map() || value.entries().size() != 1) {
    problems.add(value.position(), "expected one operator, a name with its keys, got " + value.describe());
    return false;
  }
  const Value::Entry& entry = value.entries().front();
  const auto& table = kinds();
  const auto kind =
      std::find_if(table.begin(), table.end(), [&](const auto& k) { return k.name == entry.key; });
  if (kind == table.end()) {
    std::vector<std::string> names;
    for (const OperatorKind& k : table) names.push_back(k.name);
    problems.add(entry.key_position, "unknown operator '" + entry.key + "'" + did_you_mean(entry.key, names));
    return false;
  }
  // The keys that every operator has are read by a table of their own.
  Value own = entry.value, shared = Value::map(entry.value.position(), {});
  std::erase_if(own.entries(), [&](const Value::Entry& key) {
    const bool is_shared = mask_table(*kind).find(key.key) != nullptr;
    if (is_shared) shared.entries().push_back(key);
    return is_shared;
  });
  item = {entry.key, entry.key_position, kind->read(own, suggested_key(own, *kind), problems), kind->clone};
  MaskParams params;
  if (!mask_table(*kind).read(shared, params, problems)) return false;
  for (const Field& mask : {params.mask, params.amount}) {
    if (mask.is_constant() && mask.value({}) == 1) continue;
    if (item.prototype) item.prototype = std::make_shared<MaskedOperator>(item.prototype, item.clone, mask);
    item.masked = true;
    item.clone = [](const Operator& prototype) -> std::unique_ptr<Operator> {
      return std::make_unique<MaskedOperator>(static_cast<const MaskedOperator&>(prototype));
    };
  }
  return item.prototype != nullptr;
}

}  // namespace

OperatorList::Item default_operator(std::string_view name) {
  const auto& table = kinds();
  const auto kind = std::find_if(table.begin(), table.end(), [&](const auto& k) { return k.name == name; });
  PELAGE_CHECK(kind != table.end());
  Problems problems;
  return {kind->name, {}, kind->read(Value(), {}, problems), kind->clone};
}

bool ValueReader<OperatorList>::read(const Value& value, const KeyOptions&, OperatorList& out,
                                     Problems& problems) {
  if (!value.is_list()) {
    problems.add(value.position(), "expected a list of operators, got " + value.describe());
    return false;
  }
  OperatorList list;
  bool good = true;
  for (const Value& item : value.items()) {
    list.items.emplace_back();
    good &= read_item(item, list.items.back(), problems);
  }
  if (good) out = std::move(list);
  return good;
}

std::vector<const SchemaInfo*> ValueReader<OperatorList>::blocks() {
  std::vector<const SchemaInfo*> result;
  for (const OperatorKind& kind : kinds()) result.push_back(&kind.schema());
  result.push_back(&MaskParams::schema());
  return result;
}

void ValueReader<OperatorList>::visit_blocks(Value& value, const BlockVisitor& visit) {
  for (Value& item : value.items()) {
    for (Value::Entry& entry : item.entries()) {
      for (const OperatorKind& kind : kinds()) {
        if (kind.name != entry.key) continue;
        visit(entry.value, kind.schema());
        visit(entry.value, mask_table(kind));
      }
    }
  }
}

}  // namespace pelage
