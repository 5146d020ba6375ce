// SPDX-License-Identifier: Apache-2.0
#include "geom/strand_merge.h"

#include <algorithm>

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
  std::stable_sort(sources.begin(), sources.end(), [](const Source& a, const Source& b) {
    return a.batch->id(a.strand) < b.batch->id(b.strand);
  });
  return sources;
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

// Frequency at which all batches can hold the attribute; false when one of them does not have it.
bool common_class(std::span<const Strands* const> batches, const StrandAttribute& attribute,
                  AttributeClass& widest) {
  widest = attribute.frequency;
  for (const Strands* batch : batches) {
    const StrandAttribute* other = batch->find_attribute(attribute.name);
    if (!other || other->components != attribute.components) return false;
    widest = std::max(widest, other->frequency);
    if (other->frequency == AttributeClass::kConstant && other->values != attribute.values) {
      widest = std::max(widest, AttributeClass::kPerStrand);
    }
  }
  return true;
}

}  // namespace

Strands merge(std::span<const Strands> batches) {
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
  out.points.reserve(point_count * 4 * static_cast<size_t>(out.motion_keys));
  out.first_point.reserve(sources.size() + 1);
  out.first_point.push_back(0);
  for (const Source& source : sources) {
    out.first_point.push_back(out.first_point.back() + source.batch->strand_points(source.strand));
    out.ids.push_back(source.batch->id(source.strand));
    if (has_roots) out.roots.push_back(source.batch->root(source.strand));
    if (has_uv) out.root_uv.push_back(source.batch->root_uv(source.strand));
  }
  for (int key = 0; key < out.motion_keys; ++key) {
    for (const Source& source : sources) {
      const auto points =
          source.batch->points(key).subspan(size_t(source.batch->first_point(source.strand)) * 4,
                                            size_t(source.batch->strand_points(source.strand)) * 4);
      out.points.insert(out.points.end(), points.begin(), points.end());
    }
  }
  for (const StrandAttribute& attribute : first.attributes()) {
    StrandAttribute merged{attribute.name, attribute.frequency, attribute.components, {}};
    if (!common_class(filled, attribute, merged.frequency)) continue;
    if (merged.frequency == AttributeClass::kConstant) {
      merged.values = attribute.values;
    } else {
      for (const Source& source : sources) {
        append_values(*source.batch->find_attribute(attribute.name), source, merged.frequency, merged.values);
      }
    }
    out.attributes.push_back(std::move(merged));
  }
  return Strands(std::move(out));
}

}  // namespace pelage
