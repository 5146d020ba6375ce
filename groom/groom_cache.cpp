// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>

#include "base/job.h"
#include "groom/cache/stored_follicles.h"
#include "groom/groom_impl.h"

namespace pelage {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

size_t end_of_frozen(const OperatorStack& stack, const std::string& freeze) {
  size_t end = stack.size();
  while (end > 0 && stack.operators()[end - 1]->traits().name != freeze) --end;
  return end;
}

std::optional<size_t> stored_bytes(const std::filesystem::path& file) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  return error ? std::optional<size_t>() : bytes;
}

/// Removes layers of stages that have changed: they are large and serve the next edit only. The offsets stay,
/// in case an edit is undone.
void remove_old_layers(const ContentStore& store, const GroomManifest& before, const GroomManifest& now,
                       int leaf_strands) {
  for (const GroomStage& old : before.stages()) {
    const bool current = std::any_of(now.stages().begin(), now.stages().end(),
                                     [&](const GroomStage& stage) { return stage.hash == old.hash; });
    std::error_code ignored;
    if (!current) std::filesystem::remove(layer_file(store, old.hash, leaf_strands), ignored);
  }
}

}  // namespace

void Groom::Impl::open_cache(const std::string& name, const GroomParams& params,
                             const GroomIdentity& identity, const PrepareContext& context, uint64_t seed) {
  const auto start = std::chrono::steady_clock::now();
  const Job& job = context.job;
  const WarningSink warn = [&job](const std::string& line) { job.progress.warn(line); };
  store.emplace(params.cache->directory.path);
  frozen_end = end_of_frozen(*stack, params.cache->freeze.name);

  const ContentHash follicle_key =
      in_leaves(identity.stages()[GroomIdentity::kStrands].hash, params.leaf_size());
  const ContentHash offset_key = in_leaves(identity.of_operator(frozen_end - 1).hash, params.leaf_size());
  GroomManifest now(identity, GroomIdentity::kFirstOperator + frozen_end);
  const std::optional<GroomManifest> before = GroomManifest::read(*store, name);
  report.emplace();
  report->file = FrozenCoat::file(*store, offset_key);
  report->stages = explain(now, before);

  bool have_follicles = source.imported.has_value();
  const auto open = [&](const WarningSink& sink) {
    if (!have_follicles) {
      std::optional<FollicleTree> stored =
          stored_follicles(*store, follicle_key, &source.rest->topology(), sink);
      have_follicles = stored.has_value();
      if (stored) source.grown = std::make_shared<const FollicleTree>(std::move(*stored));
    }
    if (have_follicles && !frozen) frozen = FrozenCoat::open(*store, offset_key, source, sink);
  };
  open(warn);
  report->fresh = report->stored = frozen.has_value();
  // Reports a folder that cannot be written once.
  bool told = false;
  const WarningSink cannot_store = [&](const std::string& line) {
    if (!told) warn(line);
    told = true;
  };
  if (!frozen) {
    store->sweep();
    const ContentStore::Lock lock =
        store->lock("offsets", offset_key, [&] { return job.progress.cancelled(); });
    open([](const std::string&) {});  // another process may have written it; damage has already been reported
    report->fresh = report->stored = frozen.has_value();
    if (!have_follicles) {
      stack->prepare_coverage(context);
      source.grown = std::make_shared<const FollicleTree>(place_follicles(params, context, seed));
      store_follicles(*store, follicle_key, *source.grown, cannot_store);
    }
    if (!frozen) {
      const FrozenGrowth growth{context.owner, source, *stack,       identity, frozen_end,
                                *store,        warn,   cannot_store, job};
      FrozenGrowth::Result grown = growth.run(context, params.leaf_size());
      report->resumed = grown.resumed;
      if (before) remove_old_layers(*store, *before, now, params.leaf_size());
      report->stored = FrozenCoat::store(*store, offset_key, grown.leaves, grown.reaches, cannot_store);
      // Reads the file back, so that the copy in memory can be freed.
      if (report->stored) frozen = FrozenCoat::open(*store, offset_key, source, warn);
      grown.charge = {};
      if (!frozen) frozen.emplace(std::move(grown.leaves), std::move(grown.reaches), job.ledger);
    }
  }
  // The previous state does not matter when everything needed is available.
  for (GroomCacheReport::Stage& stage : report->stages) {
    if (report->fresh) stage = {stage.name, true, ""};
  }
  // For strands of a file, only the offsets are stored.
  const std::filesystem::path follicles = source.imported ? "" : follicle_file(*store, follicle_key);
  now.add_state({report->file.filename().string(), follicles.filename().string()}, before, *store);
  if (!before || before->text() != now.text()) now.write(*store, name);
  report->files = {report->file, follicles, GroomManifest::file(*store, name)};
  for (const GroomStage& stage : now.stages())
    report->files.push_back(layer_file(*store, stage.hash, params.leaf_size()));
  if (!report->fresh) store->prune(ContentStore::kUnusedAge);
  stack->prepare(frozen_end, stack->size(), context);
  prepare_rest(name, job);
  report->strands = source.follicles().size();
  report->offset_bytes = stored_bytes(report->file).value_or(frozen->bytes());
  if (!source.imported)
    report->follicle_bytes =
        stored_bytes(follicle_file(*store, follicle_key)).value_or(source.grown->bytes());
  report->seconds = seconds_since(start);
}

}  // namespace pelage
