// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/bounds_variants.h"

#include "lab/measure/caches.h"

namespace pelage {
namespace {

constexpr const char* kTwoPass[] = {kExactId, kExactShutterId, "linear"};

class VariantMaker {
 public:
  VariantMaker(const SceneDescription& scene, const MeasureSetup& setup) : caches_(scene, setup.folder) {}

  bool cached() const { return caches_.any(); }

  /// A run of a strategy with its caches in the folder of that name.
  Variant make(const std::string& id, const std::string& title, const std::string& strategy,
               const std::string& folder) const {
    Variant variant{id, title, "render", {"--set", "render.bounds=" + strategy, "--sample-memory", "0.01"}};
    const std::vector<std::string> arguments = caches_.arguments(folder);
    variant.arguments.insert(variant.arguments.end(), arguments.begin(), arguments.end());
    return variant;
  }
  Variant cold(const std::string& strategy) const {
    Variant variant = make(strategy + "-cold", strategy + ", cold", strategy, strategy);
    variant.prepare = [caches = caches_, strategy] { caches.clear(strategy); };
    return variant;
  }

 private:
  CacheFolders caches_;
};

Switch without(const VariantMaker& maker, const std::string& id, const std::string& title,
               const std::string& key) {
  Variant variant = maker.make(id, "exact, " + title, kExactId, kExactId);
  variant.arguments.insert(variant.arguments.end(), {"--set", key + "=false"});
  return {key, std::move(variant)};
}

}  // namespace

BoundsVariants bounds_variants(const SceneDescription& scene, const MeasureSetup& setup) {
  const VariantMaker maker(scene, setup);
  BoundsVariants v;
  for (const std::string strategy : kTwoPass) {
    if (maker.cached()) v.run.push_back(maker.cold(strategy));
  }
  // Variants without boxes reuse the offsets of the cold run of exact.
  v.run.push_back(maker.make(kNoneId, "none", "none", kExactId));
  v.run.push_back(maker.make(kConservativeId, "conservative", "conservative", kExactId));
  for (size_t i = v.run.size(); i-- > 0;) {
    if (!v.run[i].id.ends_with("-cold")) v.shown.insert(v.shown.begin(), v.run[i].id);
  }
  for (const std::string strategy : kTwoPass) {
    v.run.push_back(maker.make(strategy, strategy, strategy, strategy));
    if (maker.cached()) v.shown.push_back(strategy + "-cold");
    v.shown.push_back(strategy);
  }
  v.switches = {without(maker, "wide-attributes", "attributes not compacted", "render.compact_attributes")};
  for (const Switch& s : v.switches) v.run.push_back(s.off);
  return v;
}

}  // namespace pelage
