// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_stage.h"

#include <algorithm>
#include <set>

#include "base/file.h"
#include "base/visible_text.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

constexpr size_t kMaxPrims = 1'000'000, kRecentLayers = 32, kMaxSublayerDepth = 64;
constexpr int kMaxStageDepth = 512;

/// The name of a file that all paths to it share.
std::string key_of(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::weakly_canonical(path, error);
  return error ? path.string() : full.string();
}

bool any_specifier(const UsdPrim& prim, std::string_view specifier) {
  return std::any_of(prim.opinions.begin(), prim.opinions.end(),
                     [&](const UsdOpinion& o) { return o.spec->specifier == specifier; });
}

}  // namespace

std::optional<UsdValue> UsdPrim::find(std::string_view attribute) const {
  for (const UsdOpinion& opinion : opinions) {
    const UsdAttribute* found = opinion.spec->find(attribute);
    if (!found) continue;
    const auto earliest = std::min_element(found->times.begin(), found->times.end(),
                                           [](const auto& a, const auto& b) { return a.first < b.first; });
    if (earliest != found->times.end() && !earliest->second.empty())
      return UsdValue{opinion.layer, found, earliest->second};
    if (!found->value.empty()) return UsdValue{opinion.layer, found, found->value};
  }
  return {};
}

std::string UsdPrim::token(std::string_view attribute, const std::string& other) const {
  const std::optional<UsdValue> value = find(attribute);
  if (!value) return other;
  const std::vector<std::string> texts = usd_texts(*value->layer, value->text);
  return texts.empty() ? other : texts.front();
}

std::string UsdPrim::interpolation(std::string_view attribute) const {
  for (const UsdOpinion& opinion : opinions) {
    const UsdAttribute* found = opinion.spec->find(attribute);
    if (found && !found->interpolation.empty()) return found->interpolation;
  }
  return {};
}

std::vector<std::string> UsdPrim::attribute_names() const {
  std::vector<std::string> names;
  for (const UsdOpinion& opinion : opinions) {
    for (const UsdAttribute& attribute : opinion.spec->attributes) names.push_back(attribute.name);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

void UsdPrim::fail(const std::string& message) const {
  throw Error(ErrorKind::kInput, position(), "<" + visible(path) + ">: " + message);
}

UsdStage::UsdStage(const UsdSource& source, ReadWarnings& warnings, Reserve reserve)
    : warnings_(warnings),
      reserve_(std::move(reserve)),
      composer_([this](const auto& file) { return open(file); }, warnings) {
  root_ = source.text ? with_sublayers(std::make_shared<const UsdLayer>(source.path, *source.text),
                                       key_of(source.path))
                      : open(source.path);
}

UsdStage::Stack UsdStage::open(const std::filesystem::path& path) {
  const std::string key = key_of(path);
  if (Stack known = open_[key].lock()) return known;
  const Stack stack = with_sublayers(open_layer(path, key), key);
  open_[key] = stack;
  recent_.push_back(stack);
  if (recent_.size() > kRecentLayers) recent_.pop_front();
  return stack;
}

UsdStage::Stack UsdStage::with_sublayers(std::shared_ptr<const UsdLayer> layer, const std::string& key) {
  auto stack = std::make_shared<UsdLayerStack>();
  stack->layers.push_back(std::move(layer));
  std::vector<std::string> ancestors{key};
  add_sublayers(*stack->layers.front(), *stack, ancestors);
  return stack;
}

std::shared_ptr<const UsdLayer> UsdStage::open_layer(const std::filesystem::path& path,
                                                     const std::string& key) {
  const auto known = layers_.find(key);
  std::shared_ptr<const UsdLayer> layer = known == layers_.end() ? nullptr : known->second.lock();
  if (layer) return layer;
  if (reserve_) {
    std::erase_if(layers_, [](const auto& entry) { return entry.second.expired(); });
    std::error_code error;  // UsdLayer reports it
    const uintmax_t size = std::filesystem::file_size(path, error);
    int64_t bytes = error ? 0 : static_cast<int64_t>(size);
    for (const auto& [name, open] : layers_) {
      if (const auto other = open.lock()) bytes += static_cast<int64_t>(other->text().size());
    }
    reserve_(bytes);
  }
  layer = std::make_shared<const UsdLayer>(path);
  layers_[key] = layer;
  return layer;
}

void UsdStage::add_sublayers(const UsdLayer& layer, UsdLayerStack& stack,
                             std::vector<std::string>& ancestors) {
  for (const UsdArc& arc : layer.sublayers()) {
    const std::filesystem::path path = layer.path().parent_path() / arc.asset;
    if (const std::string problem = file_problem(path); !problem.empty())
      layer.fail(arc.place, "'" + visible(path.string()) + "': " + problem);
    const std::string key = key_of(path);
    if (std::find(ancestors.begin(), ancestors.end(), key) != ancestors.end())
      layer.fail(arc.place, "sublayers contain themselves");
    if (ancestors.size() > kMaxSublayerDepth)
      layer.fail(arc.place, "sublayers are nested deeper than 64 levels");
    if (stack.layers.size() > 1000) layer.fail(arc.place, "the file has more than 1,000 sublayers");
    const std::shared_ptr<const UsdLayer> added = open_layer(path, key);
    stack.layers.push_back(added);
    ancestors.push_back(key);
    add_sublayers(*added, stack, ancestors);
    ancestors.pop_back();
  }
}

void UsdStage::visit(const std::function<void(const UsdPrim&)>& use) {
  UsdPrim root;
  UsdPrimNode node;
  node.site = std::make_shared<const UsdSite>(UsdSite{root_, "", 0, 0, nullptr});
  for (const auto& layer : root_->layers) node.specs.push_back({root_, layer.get(), &layer->root()});
  root.opinions = node.specs;
  if (root_layer().is_z_up()) up_ = M44f(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
  root.to_world = up_;
  prims_ = 0;
  visit_children(root, node, 1, use);
}

void UsdStage::visit_children(const UsdPrim& parent, const UsdPrimNode& node, int depth,
                              const std::function<void(const UsdPrim&)>& use) {
  std::vector<std::string> names;
  std::set<std::string_view> known;
  for (const UsdOpinion& opinion : parent.opinions) {
    for (const UsdPrimSpec& child : opinion.spec->children) {
      if (known.insert(child.name).second) names.push_back(child.name);
    }
  }
  for (const std::string& name : names) {
    UsdPrim prim;
    prim.path = parent.path + "/" + name;
    if (depth > kMaxStageDepth) parent.fail("prims are nested deeper than 512 levels");
    const UsdPrimNode child = composer_.child(node, name, prim.path, depth);
    prim.opinions = usd_opinions(child);
    if (++prims_ > kMaxPrims) prim.fail("the scene has more than 1,000,000 prims");
    for (const UsdOpinion& opinion : prim.opinions) {
      if (prim.type.empty()) prim.type = opinion.spec->type;
    }
    if (!is_shown(prim)) continue;
    bool resets = false;
    const M44f local = usd_local_transform(prim, resets, warnings_);
    prim.to_world = local * (resets ? up_ : parent.to_world);
    use(prim);
    visit_children(prim, child, depth + 1, use);
  }
}

bool UsdStage::is_shown(const UsdPrim& prim) {
  if (!any_specifier(prim, "def") || prim.opinions.front().spec->specifier == "class") return false;
  for (const UsdOpinion& opinion : prim.opinions) {
    if (!opinion.spec->has_active) continue;
    if (!opinion.spec->active) return false;
    break;
  }
  if (prim.token("visibility", "inherited") == "invisible") {
    warnings_.add("invisible prims are skipped", prim.position());
    return false;
  }
  const std::string purpose = prim.token("purpose", "default");
  if (purpose == "guide" || purpose == "proxy") {
    warnings_.add("prims with the purpose '" + purpose + "' are skipped", prim.position());
    return false;
  }
  if (prim.type == "PointInstancer") {
    warnings_.add("PointInstancer prims are skipped", prim.position());
    return false;
  }
  return true;
}

}  // namespace pelage
