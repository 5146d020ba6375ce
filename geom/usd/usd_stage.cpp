// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_stage.h"

#include <algorithm>

#include "base/file.h"
#include "base/visible_text.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

constexpr size_t kMaxPrims = 1'000'000, kMaxChain = 256, kRecentLayers = 32;
constexpr ptrdiff_t kMaxRepetitions = 4;
constexpr int kMaxSublayerDepth = 64;

std::shared_ptr<const UsdLayer> open_layer(const std::filesystem::path& path) {
  return std::make_shared<const UsdLayer>(path);
}

/// What the layers of a stack state about the prim with a path.
std::vector<UsdOpinion> opinions_at(const std::shared_ptr<const UsdLayerStack>& stack,
                                    const std::string& path) {
  std::vector<UsdOpinion> found;
  for (const auto& layer : stack->layers) {
    const UsdPrimSpec* spec = &layer->root();
    for (size_t begin = 1; spec && begin < path.size();) {
      const size_t end = std::min(path.find('/', begin), path.size());
      spec = spec->child(path.substr(begin, end - begin));
      begin = end + 1;
    }
    if (spec) found.push_back({stack, layer.get(), spec});
  }
  return found;
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
    if (!found->value.empty()) return UsdValue{opinion.layer, found, found->value};
    const auto earliest = std::min_element(found->times.begin(), found->times.end(),
                                           [](const auto& a, const auto& b) { return a.first < b.first; });
    if (earliest != found->times.end() && !earliest->second.empty())
      return UsdValue{opinion.layer, found, earliest->second};
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

UsdStage::UsdStage(const std::filesystem::path& path, UsdWarnings& warnings) : warnings_(warnings) {
  root_ = open(path);
}

UsdStage::UsdStage(const std::filesystem::path& path, std::string_view text, UsdWarnings& warnings)
    : warnings_(warnings) {
  auto stack = std::make_shared<UsdLayerStack>();
  stack->layers.push_back(std::make_shared<const UsdLayer>(path, text));
  add_sublayers(*stack->layers.front(), *stack, 0);
  root_ = stack;
}

UsdStage::Stack UsdStage::open(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::weakly_canonical(path, error);
  const std::string key = error ? path.string() : full.string();
  if (Stack known = open_[key].lock()) return known;
  auto stack = std::make_shared<UsdLayerStack>();
  stack->layers.push_back(open_layer(path));
  add_sublayers(*stack->layers.front(), *stack, 0);
  open_[key] = stack;
  recent_.push_back(stack);
  if (recent_.size() > kRecentLayers) recent_.pop_front();
  return stack;
}

void UsdStage::add_sublayers(const UsdLayer& layer, UsdLayerStack& stack, int depth) {
  for (const UsdArc& arc : layer.sublayers()) {
    const std::filesystem::path path = layer.path().parent_path() / arc.asset;
    if (const std::string problem = file_problem(path); !problem.empty())
      layer.fail(arc.place, "'" + visible(path.string()) + "': " + problem);
    if (depth == kMaxSublayerDepth) layer.fail(arc.place, "sublayers contain themselves");
    if (stack.layers.size() > 1000) layer.fail(arc.place, "the file has more than 1,000 sublayers");
    stack.layers.push_back(open_layer(path));
    const std::shared_ptr<const UsdLayer> added = stack.layers.back();
    add_sublayers(*added, stack, depth + 1);
  }
}

void UsdStage::visit(const std::function<void(const UsdPrim&)>& use) {
  UsdPrim root;
  for (const auto& layer : root_->layers) root.opinions.push_back({root_, layer.get(), &layer->root()});
  if (root_layer().is_z_up()) up_ = M44f(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
  root.to_world = up_;
  prims_ = 0;
  visit_children(root, {}, use);
}

void UsdStage::visit_children(const UsdPrim& parent, const Chain& chain,
                              const std::function<void(const UsdPrim&)>& use) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<UsdOpinion>> children;
  for (const UsdOpinion& opinion : parent.opinions) {
    for (const UsdPrimSpec& child : opinion.spec->children) {
      std::vector<UsdOpinion>& of_name = children[child.name];
      if (of_name.empty()) names.push_back(child.name);
      of_name.push_back({opinion.stack, opinion.layer, &child});
    }
  }
  for (const std::string& name : names) {
    UsdPrim prim;
    prim.path = parent.path + "/" + name;
    prim.opinions = std::move(children[name]);
    if (++prims_ > kMaxPrims) prim.fail("the scene has more than 1,000,000 prims");
    Chain longer = chain;
    expand(prim.opinions, longer);
    for (const UsdOpinion& opinion : prim.opinions) {
      if (prim.type.empty()) prim.type = opinion.spec->type;
    }
    if (!is_shown(prim)) continue;
    bool resets = false;
    const M44f local = usd_local_transform(prim, resets, warnings_);
    prim.to_world = local * (resets ? up_ : parent.to_world);
    use(prim);
    visit_children(prim, longer, use);
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

/// Adds what references, payloads, inherited prims and variants state, in the order of their strength.
void UsdStage::expand(std::vector<UsdOpinion>& opinions, Chain& chain) {
  for (size_t first = 0; first < opinions.size();) {
    const size_t end = opinions.size();
    std::vector<UsdOpinion> added;
    for (size_t i = first; i < end; ++i) {
      const UsdOpinion from = opinions[i];
      for (const std::string& path : from.spec->inherits)
        add_target(from.stack, path, from, from.spec->place, chain, added);
    }
    for (size_t i = first; i < end; ++i) add_variants(opinions[i], opinions, added);
    for (size_t i = first; i < end; ++i) {
      const UsdOpinion from = opinions[i];
      for (const UsdArc& arc : from.spec->references) add_arc(from, arc, chain, added);
    }
    for (size_t i = first; i < end; ++i) {
      const UsdOpinion from = opinions[i];
      for (const UsdArc& arc : from.spec->payloads) add_arc(from, arc, chain, added);
    }
    opinions.insert(opinions.end(), added.begin(), added.end());
    first = end;
  }
}

void UsdStage::add_variants(const UsdOpinion& opinion, const std::vector<UsdOpinion>& all,
                            std::vector<UsdOpinion>& added) {
  for (const auto& [set, variants] : opinion.spec->variant_sets) {
    const std::string* selected = nullptr;
    for (const UsdOpinion& other : all) {
      const auto found = other.spec->selections.find(set);
      if (!selected && found != other.spec->selections.end()) selected = &found->second;
    }
    if (!selected) {
      warnings_.add("variant sets without a selection are skipped",
                    opinion.layer->position(opinion.spec->place));
      continue;
    }
    for (const UsdPrimSpec& variant : variants) {
      if (variant.name == *selected) added.push_back({opinion.stack, opinion.layer, &variant});
    }
  }
}

void UsdStage::add_arc(const UsdOpinion& from, const UsdArc& arc, Chain& chain,
                       std::vector<UsdOpinion>& added) {
  Stack stack = from.stack;
  if (!arc.asset.empty()) {
    const std::filesystem::path path = from.layer->path().parent_path() / arc.asset;
    if (const std::string problem = file_problem(path); !problem.empty())
      from.layer->fail(arc.place, "'" + visible(path.string()) + "': " + problem);
    stack = open(path);
  }
  std::string target = arc.path;
  if (target.empty()) target = "/" + stack->layers.front()->default_prim();
  if (target == "/") from.layer->fail(arc.place, "the file has no default prim; name one: @file@</prim>");
  add_target(stack, target, from, arc.place, chain, added);
}

void UsdStage::add_target(const Stack& stack, const std::string& path, const UsdOpinion& from, size_t place,
                          Chain& chain, std::vector<UsdOpinion>& added) {
  if (!path.starts_with('/')) {
    warnings_.add("relative paths of prims are skipped", from.layer->position(place));
    return;
  }
  const std::string site = stack->layers.front()->path().string() + "<" + path + ">";
  // A prim may name the same prim as its parent does, so one repetition is no cycle.
  if (std::count(chain.begin(), chain.end(), site) >= kMaxRepetitions || chain.size() >= kMaxChain)
    from.layer->fail(place, "<" + visible(path) + "> refers to itself");
  const std::vector<UsdOpinion> found = opinions_at(stack, path);
  if (found.empty()) from.layer->fail(place, "there is no prim <" + visible(path) + ">");
  chain.push_back(site);
  added.insert(added.end(), found.begin(), found.end());
}

}  // namespace pelage
