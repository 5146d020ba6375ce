// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/medulla_tables.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/program_identity.h"
#include "base/progress.h"
#include "render/fibre/fibre_tracer.h"

namespace pelage {
namespace {

constexpr const char* kTablesKind = "medulla";
/// The last node of the inclination: hardly any light enters a fibre at larger angles.
constexpr float kSteepest = 1.5f;

using Node = MedullaTables::Node;
static_assert(std::is_trivially_copyable_v<Node> && sizeof(Node) % sizeof(float) == 0);

ContentHash key_of(const YanOptics& o, int paths) {
  ContentHasher hasher;
  hasher.add(MedullaTables::kVersion)
      .add(arithmetic_identity())
      .add(paths)
      .add(o.eta)
      .add(o.kappa)
      .add(o.sigma_ms)
      .add(o.g)
      .add(o.layers);
  return hasher.digest();
}

/// Converts counts to a cumulative distribution, with a small constant so that no density is zero.
template <size_t N>
void accumulate(std::array<float, N>& cells) {
  constexpr float added = 0.5f;
  double sum = 0;
  for (size_t i = 0; i + 1 < N; ++i) sum += cells[i] + added;
  double below = 0;
  for (size_t i = 0; i + 1 < N; ++i) {
    const double count = cells[i] + added;
    cells[i] = static_cast<float>(below / sum);
    below += count;
  }
  cells[N - 1] = 1;
}

Node make_node(const TracedFibre& fibre, float theta, float h, uint64_t seed, int paths, const Job& job) {
  constexpr int kPathsPerCheck = 64;  // paths
  Node node{};
  std::vector<FibrePath> scattered;
  for (int k = 0; k < paths; ++k) {
    if (k % kPathsPerCheck == 0) job.check_stop();
    const FibrePath path = trace_fibre(fibre, std::sin(theta), h, seed, static_cast<uint64_t>(k));
    if (!path.scattered) continue;
    scattered.push_back(path);
    const float turn = std::atan2(path.wi.z, path.wi.y) / (2 * kPi) + 0.5f;
    const int azimuth = static_cast<int>(turn * MedullaTables::kAzimuths);
    const int sine = static_cast<int>((path.wi.x + 1) * 0.5f * MedullaTables::kSines);
    node.azimuth[std::clamp(azimuth, 0, MedullaTables::kAzimuths - 1)] += 1;
    node.sine[path.wi.y < 0][std::clamp(sine, 0, MedullaTables::kSines - 1)] += 1;
  }
  node.lengths = PathLengths(std::move(scattered));
  accumulate(node.azimuth);
  for (auto& half : node.sine) accumulate(half);
  return node;
}

template <size_t N>
float cell_density(const std::array<float, N>& cumulative, float place, float cell) {
  const int i = std::clamp(static_cast<int>(place * (N - 1)), 0, static_cast<int>(N) - 2);
  return (cumulative[i + 1] - cumulative[i]) / cell;
}
/// Samples a position in [0, 1) with that distribution.
template <size_t N>
float place_at(const std::array<float, N>& cumulative, float xi) {
  const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, xi);
  const auto i = static_cast<size_t>(above - cumulative.begin()) - 1;
  const float t = (xi - cumulative[i]) / (cumulative[i + 1] - cumulative[i]);
  return std::min((static_cast<float>(i) + std::clamp(t, 0.0f, kBelowOne)) / (N - 1), kBelowOne);
}

}  // namespace

std::shared_ptr<const MedullaTables> MedullaTables::make(const YanOptics& o, const Job& job, int paths) {
  auto tables = std::make_shared<MedullaTables>();
  tables->nodes_.resize(static_cast<size_t>(kInclinations) * kOffsets);
  const TracedFibre fibre{o.eta, o.layers, o.kappa, o.sigma_ms, o.g};
  const ProgressStage stage(job.progress, "medulla tables", static_cast<double>(tables->nodes_.size()));
  job.for_each(tables->nodes_.size(), 1, [&](const WorkRange& range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      const auto inclination = static_cast<float>(i / kOffsets), offset = static_cast<float>(i % kOffsets);
      tables->nodes_[i] = make_node(fibre, kSteepest * inclination / (kInclinations - 1),
                                    (offset + 0.5f) / kOffsets, i, paths, job);
      job.progress.advance(1);
    }
  });
  return tables;
}

std::shared_ptr<const MedullaTables> MedullaTables::make(const YanOptics& o, const Workers& workers,
                                                         int paths) {
  MemoryLedger ledger;
  NoProgress progress;
  return make(o, Job{workers, ledger, progress}, paths);
}

std::shared_ptr<const MedullaTables> MedullaTables::find_or_make(const YanOptics& optics,
                                                                 const ContentStore& store, const Job& job,
                                                                 int paths) {
  const WarningSink warn = [&](const std::string& line) { job.progress.warn(line); };
  const ContentHash key = key_of(optics, paths);
  const size_t bytes = static_cast<size_t>(kInclinations) * kOffsets * sizeof(Node);
  const auto stored = [&](const WarningSink& tell) -> std::shared_ptr<const MedullaTables> {
    const std::optional<StoredFile> file = store.open(kTablesKind, key, tell);
    if (!file) return nullptr;
    if (file->section_count() != 1 || file->section(0).size() != bytes) {
      tell(store.file(kTablesKind, key).string() + ": not medulla tables; they are made again");
      return nullptr;
    }
    auto tables = std::make_shared<MedullaTables>();
    tables->nodes_.resize(static_cast<size_t>(kInclinations) * kOffsets);
    std::memcpy(static_cast<void*>(tables->nodes_.data()), file->section(0).data(), bytes);
    return tables;
  };
  if (auto found = stored(warn)) return found;
  const ContentStore::Lock lock = store.lock(kTablesKind, key, [&] { return job.progress.cancelled(); });
  if (auto found = stored([](const std::string&) {})) return found;  // made while we waited
  std::shared_ptr<const MedullaTables> made = make(optics, job, paths);
  const std::span<const std::byte> section = std::as_bytes(made->nodes());
  store.store(kTablesKind, key, std::span(&section, 1), warn);
  return made;
}

TabulatedScatter::TabulatedScatter(const MedullaTables& tables, float sin_theta_o, float h)
    : inclination_sign_(sin_theta_o < 0 ? -1.0f : 1.0f), offset_sign_(h < 0 ? -1.0f : 1.0f) {
  constexpr int kInclinations = MedullaTables::kInclinations, kOffsets = MedullaTables::kOffsets;
  const float theta = std::asin(std::min(std::abs(sin_theta_o), 1.0f));
  const float x = std::min(theta / kSteepest, 1.0f) * (kInclinations - 1);
  const float y = std::clamp(std::abs(h) * kOffsets - 0.5f, 0.0f, static_cast<float>(kOffsets - 1));
  const int i = std::min(static_cast<int>(x), kInclinations - 2),
            j = std::min(static_cast<int>(y), kOffsets - 2);
  const float s = x - static_cast<float>(i), t = y - static_cast<float>(j);
  nodes_ = {&tables.node(i, j), &tables.node(i, j + 1), &tables.node(i + 1, j), &tables.node(i + 1, j + 1)};
  weights_ = {(1 - s) * (1 - t), (1 - s) * t, s * (1 - t), s * t};
}

float TabulatedScatter::density(const FibreAngles& a) const {
  constexpr float kAzimuthCell = 2 * kPi / MedullaTables::kAzimuths, kSineCell = 2.0f / MedullaTables::kSines;
  const float phi = offset_sign_ * a.phi;
  const int behind = std::abs(phi) > kPi / 2;
  const float turn = phi / (2 * kPi) + 0.5f, sine = (inclination_sign_ * a.sin_theta + 1) * 0.5f;
  float sum = 0;
  for (int k = 0; k < 4; ++k) {
    const Node& node = *nodes_[k];
    sum += weights_[k] * cell_density(node.azimuth, turn, kAzimuthCell) *
           cell_density(node.sine[behind], sine, kSineCell);
  }
  return sum;
}

SampledAngles TabulatedScatter::sample(const V3f& u) const {
  int k = 0;
  float rest = u.z;
  while (k < 3 && rest >= weights_[k]) rest -= weights_[k++];
  const Node& node = *nodes_[k];
  const float phi = 2 * kPi * (place_at(node.azimuth, u.x) - 0.5f);
  const float sine = 2 * place_at(node.sine[std::abs(phi) > kPi / 2], u.y) - 1;
  return {inclination_sign_ * sine, offset_sign_ * phi};
}

PathLengths TabulatedScatter::lengths() const {
  const float upper = weights_[2] + weights_[3];
  const float across = weights_[1] + weights_[3];
  return PathLengths::mix(PathLengths::mix(nodes_[0]->lengths, nodes_[1]->lengths, across),
                          PathLengths::mix(nodes_[2]->lengths, nodes_[3]->lengths, across), upper);
}

}  // namespace pelage
