// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/growth_edits.h"

#include <cmath>

#include <fmt/format.h>

#include "base/file_name.h"
#include "groom/cache/cache_report.h"
#include "groom/cache/frozen_coat.h"
#include "lab/measure/caches.h"

namespace pelage {
namespace {

size_t frozen_count(const GroomParams& params) {
  size_t end = params.operators.items.size();
  while (end > 0 && params.operators.items[end - 1].name != params.cache->freeze.name) --end;
  return end;
}

/// The files with the states after each frozen operator except the last; empty when the cache was not filled.
std::vector<std::filesystem::path> layers_of(const std::string& groom, const GroomParams& params,
                                             const std::filesystem::path& cache) {
  const ContentStore store(cache);
  std::vector<std::filesystem::path> layers;
  const auto manifest = GroomManifest::read(store, groom);
  if (!manifest) return layers;
  const auto& stages = manifest->stages();
  for (size_t i = GroomIdentity::kFirstOperator; i + 1 < stages.size(); ++i)
    layers.push_back(layer_file(store, stages[i].hash, params.leaf_size()));
  return layers;
}

/// Simulates an edit of operator `place`: removes the results of this operator and of all operators after it.
void remove_cached_from(size_t place, const std::string& groom, const GroomParams& params,
                        const std::filesystem::path& cache) {
  const auto layers = layers_of(groom, params, cache);
  std::error_code ignored;
  for (size_t i = place; i < layers.size(); ++i) std::filesystem::remove(layers[i], ignored);
  std::vector<std::filesystem::path> offsets;
  for (std::filesystem::directory_iterator at(cache, ignored), end; !ignored && at != end;
       at.increment(ignored)) {
    if (at->path().filename().string().starts_with("offsets-")) offsets.push_back(at->path());
  }
  for (const auto& file : offsets) std::filesystem::remove(file, ignored);
}

}  // namespace

std::vector<GrowthEdit> growth_edits(const std::string& groom, const GroomParams& params,
                                     const std::filesystem::path& cache, const Variant& common) {
  std::vector<GrowthEdit> edits;
  for (size_t i = 0; i < frozen_count(params); ++i) {
    const std::string& op = params.operators.items[i].name;
    Variant variant = common;
    variant.id = fmt::format("{}-edit-{}-{}", file_name_of({groom}), i + 1, op);
    variant.title = fmt::format("{}, {} edited", groom, op);
    variant.prepare = [=] { remove_cached_from(i, groom, params, cache); };
    edits.push_back({op, i, std::move(variant)});
  }
  return edits;
}

Table edit_table(const std::string& groom, const GroomParams& params, const std::filesystem::path& cache,
                 const std::vector<GrowthEdit>& edits, const std::vector<Outcome>& outcomes,
                 const Outcome& cold) {
  Table table{
      fmt::format("{}: cost of growing again after an edit of one operator, and the layer of this operator.",
                  groom),
      {{"operator", "operator edited"},
       {"recomputed", "operators run", Quantity::kCount},
       {"edit_s", "time of the cache", Quantity::kSeconds},
       {"part_of_whole", "relative to an empty cache"},
       {"layer_bytes", "its layer", Quantity::kBytes}},
      {}};
  const auto layers = layers_of(groom, params, cache);
  for (size_t i = 0; i < std::min(edits.size(), outcomes.size()); ++i) {
    const double edit = outcomes[i].number("stages_s.cache");
    double bytes = NAN;
    std::error_code failed;
    if (edits[i].place < layers.size()) {
      const auto size = std::filesystem::file_size(layers[edits[i].place], failed);
      if (!failed) bytes = static_cast<double>(size);
    }
    table.rows.push_back({Text{edits[i].op}, static_cast<double>(edits.size() - edits[i].place), edit,
                          edit / cold.number("stages_s.cache"), bytes});
  }
  return table;
}

}  // namespace pelage
