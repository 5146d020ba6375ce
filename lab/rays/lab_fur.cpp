// SPDX-License-Identifier: Apache-2.0
#include "lab/rays/lab_fur.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "base/parallel.h"

namespace pelage {
namespace {

const std::string kKind = "lab-fur";

struct Head {
  CurveBasis basis;
  int32_t motion_keys;
  float root_width;
  float centre[3];
};

std::vector<const Procedural*> leaves_of(const FurPart& part,
                                         std::vector<std::unique_ptr<Procedural>>& made) {
  std::vector<const Procedural*> waiting, leaves;
  for (const auto& procedural : part.procedurals) waiting.push_back(procedural.get());
  while (!waiting.empty()) {
    const Procedural* procedural = waiting.back();
    waiting.pop_back();
    auto children = procedural->split();
    if (children.empty()) leaves.push_back(procedural);
    for (auto& child : children) {
      waiting.push_back(child.get());
      made.push_back(std::move(child));
    }
  }
  return leaves;
}

/// Appends batches.
class Gatherer {
 public:
  void add(const Strands& strands) {
    if (strands.strand_count() == 0) return;
    if (arrays_.first_point.empty()) {
      arrays_.basis = strands.basis();
      arrays_.motion_keys = strands.motion_keys();
      arrays_.first_point.push_back(0);
      points_.resize(static_cast<size_t>(strands.motion_keys()));
    }
    if (strands.basis() != arrays_.basis || strands.motion_keys() != arrays_.motion_keys) {
      throw Error(
          ErrorKind::kArguments,
          "the grooms have different curve bases or motion keys; rays can be measured on one kind only");
    }
    for (size_t key = 0; key < points_.size(); ++key) {
      const auto& own = strands.points(static_cast<int>(key));
      points_[key].insert(points_[key].end(), own.begin(), own.end());
    }
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const uint64_t end = uint64_t(arrays_.first_point.back()) + strands.strand_points(s);
      if (end > UINT32_MAX)
        throw Error(ErrorKind::kArguments, "the scene has too much fur to measure at once");
      arrays_.first_point.push_back(static_cast<uint32_t>(end));
      arrays_.ids.push_back(arrays_.ids.size());
    }
  }
  bool empty() const { return arrays_.ids.empty(); }
  Strands finish() {
    for (auto& key : points_) {
      arrays_.points.insert(arrays_.points.end(), key.begin(), key.end());
      key = {};
    }
    return Strands(std::move(arrays_));
  }

 private:
  StrandArrays arrays_;
  std::vector<std::vector<float>> points_;  // by motion key
};

V3f centre_of(const Strands& strands) {
  Box3f box;
  for (size_t i = 0; i < strands.point_count(); ++i) box.extendBy(strands.point(i));
  return box.center();
}

}  // namespace

size_t LabFur::segment_count() const {
  size_t count = 0;
  for (size_t s = 0; s < strands.strand_count(); ++s)
    count += pelage::segment_count(strands.basis(), strands.strand_points(s));
  return count;
}

LabFur grow_lab_fur(const RenderScene& scene, const Job& job) {
  LabFur fur;
  std::vector<float> widths;
  Gatherer gatherer;
  for (const FurPart& part : scene.fur) {
    std::vector<std::unique_ptr<Procedural>> made;
    const std::vector<const Procedural*> leaves = leaves_of(part, made);
    std::vector<Strands> grown(leaves.size());
    job.progress.begin("grow " + part.name, static_cast<double>(leaves.size()));
    job.workers.for_each(leaves.size(), 1, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end && !job.progress.cancelled(); ++i) {
        grown[i] = leaves[i]->generate();
        job.progress.advance(1);
      }
    });
    job.progress.end();
    for (Strands& strands : grown) {
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        widths.push_back(2 * strands.points()[size_t(strands.first_point(s)) * 4 + 3]);
      }
      gatherer.add(strands);
      strands = {};
    }
  }
  if (gatherer.empty()) throw Error(ErrorKind::kArguments, "the scene has no fur to trace rays through");
  // One tree has one grid: coarse enough that most strands fit narrow leaves.
  const auto percentile = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() * 9 / 10);
  std::nth_element(widths.begin(), percentile, widths.end());
  fur.root_width = *percentile;
  fur.strands = gatherer.finish();
  fur.centre = centre_of(fur.strands);
  return fur;
}

void store_lab_fur(const ContentStore& store, const LabFur& fur) {
  const StrandArrays& arrays = fur.strands.arrays();
  const Head head{
      arrays.basis, arrays.motion_keys, fur.root_width, {fur.centre.x, fur.centre.y, fur.centre.z}};
  ContentStore::Writer writer = store.writer(kKind, kLabKey);
  writer.add(std::span<const Head>(&head, 1));
  writer.add(std::span<const float>(arrays.points));
  writer.add(std::span<const uint32_t>(arrays.first_point));
  writer.commit([](const std::string& line) { throw Error(ErrorKind::kFailed, line); });
}

LabFur load_lab_fur(const ContentStore& store) {
  const auto file =
      store.open(kKind, kLabKey, [](const std::string& line) { throw Error(ErrorKind::kFailed, line); });
  if (!file || file->section_count() != 3 || file->section(0).size() != sizeof(Head))
    throw Error(ErrorKind::kFailed, store.folder().string() + ": no prepared fur found here");
  Head head;
  std::memcpy(&head, file->section(0).data(), sizeof(head));
  StrandArrays arrays;
  arrays.basis = head.basis;
  arrays.motion_keys = head.motion_keys;
  arrays.points.resize(file->section(1).size() / sizeof(float));
  std::memcpy(arrays.points.data(), file->section(1).data(), file->section(1).size());
  arrays.first_point.resize(file->section(2).size() / sizeof(uint32_t));
  std::memcpy(arrays.first_point.data(), file->section(2).data(), file->section(2).size());
  for (uint64_t id = 0; id + 1 < arrays.first_point.size(); ++id) arrays.ids.push_back(id);
  LabFur fur;
  fur.strands = Strands(std::move(arrays));
  fur.root_width = head.root_width;
  fur.centre = V3f(head.centre[0], head.centre[1], head.centre[2]);
  return fur;
}

}  // namespace pelage
