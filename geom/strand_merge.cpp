// SPDX-License-Identifier: Apache-2.0
#include "geom/strand_merge.h"

#include <algorithm>
#include <numeric>

#include "base/check.h"

namespace pelage {

namespace {

struct Source {
  const Strands* batch;
  uint32_t strand;
};

std::vector<Source> sources_by_id(std::span<const Strands> batches) {
  std::vector<Source> sources;
  for (const Strands& batch : batches) {
    for (uint32_t i = 0; i < batch.strand_count(); ++i) sources.push_back({&batch, i});
  }
  const auto id = [](const Source& source) { return source.batch->id(source.strand); };
  uint64_t end = 0;
  for (const Source& source : sources) end = std::max(end, id(source));
  if (end > 2 * sources.size()) {
    std::stable_sort(sources.begin(), sources.end(),
                     [&](const Source& a, const Source& b) { return id(a) < id(b); });
    return sources;
  }
  // The ids of grown coats are dense: each strand's place follows from the number of smaller ids.
  std::vector<uint32_t> places(end + 2);
  for (const Source& source : sources) ++places[id(source) + 1];
  std::partial_sum(places.begin(), places.end(), places.begin());
  std::vector<Source> sorted(sources.size());
  for (const Source& source : sources) sorted[places[id(source)]++] = source;
  return sorted;
}

// The attribute of this name in a batch; `missing` if it has none.
const StrandAttribute& attribute_of(const Strands& batch, const StrandAttribute& missing) {
  const StrandAttribute* own = batch.find_attribute(missing.name);
  return own ? *own : missing;
}

// Appends the values of `from` for one strand, converted to the frequency `to`.
void append_values(const StrandAttribute& from, const Source& source, AttributeClass to,
                   std::vector<float>& out) {
  const auto components = static_cast<size_t>(from.components);
  const size_t points = source.batch->strand_points(source.strand);
  const size_t repeats = to == AttributeClass::kPerPoint ? points : 1;
  for (size_t i = 0; i < repeats; ++i) {
    size_t index = 0;
    if (from.frequency == AttributeClass::kPerStrand) index = source.strand;
    if (from.frequency == AttributeClass::kPerPoint) index = source.batch->first_point(source.strand) + i;
    const float* values = &from.values[index * components];
    out.insert(out.end(), values, values + components);
  }
}

// Frequency at which all batches can hold the attribute; false when they have different numbers of
// components.
bool common_class(std::span<const Strands* const> batches, const StrandAttribute& missing,
                  AttributeClass& widest) {
  widest = AttributeClass::kConstant;
  const std::vector<float>& values = attribute_of(*batches.front(), missing).values;
  for (const Strands* batch : batches) {
    const StrandAttribute& own = attribute_of(*batch, missing);
    if (own.components != missing.components) return false;
    widest = std::max(widest, own.frequency);
    if (own.frequency == AttributeClass::kConstant && own.values != values)
      widest = std::max(widest, AttributeClass::kPerStrand);
  }
  return true;
}

// Every attribute of the batches once, with the constant value of strands that lack it.
std::vector<StrandAttribute> all_attributes(std::span<const Strands* const> batches) {
  std::vector<StrandAttribute> all;
  for (const Strands* batch : batches) {
    for (const StrandAttribute& attribute : batch->attributes()) {
      const auto same = [&](const StrandAttribute& other) { return other.name == attribute.name; };
      if (std::any_of(all.begin(), all.end(), same)) continue;
      const float value = attribute.name == "color" || attribute.name == "opacity" ? 1.0f : 0.0f;
      all.push_back({attribute.name, AttributeClass::kConstant, attribute.components,
                     std::vector<float>(static_cast<size_t>(attribute.components), value)});
    }
  }
  return all;
}

}  // namespace

Strands merge(std::span<const Strands> batches, const Workers& workers) {
  std::vector<const Strands*> filled;
  for (const Strands& batch : batches) {
    if (batch.strand_count() > 0) filled.push_back(&batch);
  }
  if (filled.empty()) return {};
  const Strands& first = *filled.front();
  bool has_roots = true, has_uv = true;
  size_t point_count = 0;
  for (const Strands* batch : filled) {
    PELAGE_CHECK(batch->basis() == first.basis() && batch->motion_keys() == first.motion_keys());
    has_roots &= batch->has_roots();
    has_uv &= !batch->arrays().root_uv.empty();
    point_count += batch->point_count();
  }

  const std::vector<Source> sources = sources_by_id(batches);
  StrandArrays out;
  out.basis = first.basis();
  out.motion_keys = first.motion_keys();
  out.points.resize(point_count * 4 * static_cast<size_t>(out.motion_keys));
  out.first_point.reserve(sources.size() + 1);
  out.first_point.push_back(0);
  for (const Source& source : sources) {
    out.first_point.push_back(out.first_point.back() + source.batch->strand_points(source.strand));
    out.ids.push_back(source.batch->id(source.strand));
    if (has_roots) out.roots.push_back(source.batch->root(source.strand));
    if (has_uv) out.root_uv.push_back(source.batch->root_uv(source.strand));
  }
  workers.for_each(sources.size(), 4096, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      const auto [batch, strand] = sources[i];
      for (int key = 0; key < out.motion_keys; ++key) {
        const auto points = batch->points(key).subspan(size_t(batch->first_point(strand)) * 4,
                                                       size_t(batch->strand_points(strand)) * 4);
        std::copy(points.begin(), points.end(),
                  out.points.data() + (static_cast<size_t>(key) * point_count + out.first_point[i]) * 4);
      }
    }
  });
  for (const StrandAttribute& missing : all_attributes(filled)) {
    StrandAttribute merged{missing.name, missing.frequency, missing.components, {}};
    if (!common_class(filled, missing, merged.frequency)) continue;
    if (merged.frequency == AttributeClass::kConstant) {
      merged.values = attribute_of(first, missing).values;
    } else {
      for (const Source& source : sources)
        append_values(attribute_of(*source.batch, missing), source, merged.frequency, merged.values);
    }
    out.attributes.push_back(std::move(merged));
  }
  return Strands(std::move(out));
}

}  // namespace pelage
