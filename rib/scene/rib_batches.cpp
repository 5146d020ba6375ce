// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_batches.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

constexpr float kLargest = 1e18f;

bool usable(float x) { return std::isfinite(x) && std::abs(x) <= kLargest; }

bool same_form(const StrandArrays& a, const StrandArrays& b) {
  const auto same = [](const StrandAttribute& x, const StrandAttribute& y) {
    return x.name == y.name && x.frequency == y.frequency && x.components == y.components &&
           (x.frequency != AttributeClass::kConstant || x.values == y.values);
  };
  return a.basis == b.basis && a.motion_keys == b.motion_keys &&
         (a.ids.empty() || a.root_uv.empty() == b.root_uv.empty()) &&
         std::equal(a.attributes.begin(), a.attributes.end(), b.attributes.begin(), b.attributes.end(), same);
}

/// Attribute values of the strands [begin, end).
void append_values(const StrandAttribute& from, const StrandArrays& strands, size_t begin, size_t end,
                   StrandAttribute& to) {
  if (from.frequency == AttributeClass::kConstant) {
    to.values = from.values;
    return;
  }
  const bool points = from.frequency == AttributeClass::kPerPoint;
  const auto n = static_cast<size_t>(from.components);
  const size_t first = n * (points ? strands.first_point[begin] : begin);
  const size_t last = n * (points ? strands.first_point[end] : end);
  to.values.insert(to.values.end(), from.values.begin() + static_cast<ptrdiff_t>(first),
                   from.values.begin() + static_cast<ptrdiff_t>(last));
}

bool is_good(const StrandArrays& a, size_t strand) {
  const size_t all = a.first_point.back();
  bool extent = false;
  for (int key = 0; key < a.motion_keys; ++key) {
    const float* p = &a.points[4 * (static_cast<size_t>(key) * all + a.first_point[strand])];
    for (size_t i = 0; i < a.first_point[strand + 1] - a.first_point[strand]; ++i) {
      for (size_t axis = 0; axis < 3; ++axis) {
        if (!usable(p[4 * i + axis])) return false;
        extent |= p[4 * i + axis] != p[axis];
      }
    }
  }
  return extent;
}

void make_finite(StrandArrays& a) {
  for (size_t i = 3; i < a.points.size(); i += 4)
    a.points[i] = usable(a.points[i]) ? std::max(0.0f, a.points[i]) : 0;
  for (StrandAttribute& attribute : a.attributes) {
    for (float& value : attribute.values) value = std::isfinite(value) ? value : 0;
  }
  for (V2f& uv : a.root_uv) uv = usable(uv.x) && usable(uv.y) ? uv : V2f(0);
}

void drop_bad(StrandArrays& a, size_t& dropped) {
  std::vector<bool> good(a.ids.size());
  for (size_t s = 0; s < good.size(); ++s) good[s] = is_good(a, s);
  const auto bad = static_cast<size_t>(std::count(good.begin(), good.end(), false));
  if (bad == 0) return;
  dropped += bad;
  StrandArrays kept;
  std::vector<std::vector<float>> keys(static_cast<size_t>(a.motion_keys));
  kept.basis = a.basis;
  kept.motion_keys = a.motion_keys;
  kept.first_point = {0};
  for (const StrandAttribute& attribute : a.attributes)
    kept.attributes.push_back({attribute.name, attribute.frequency, attribute.components, {}});
  for (size_t s = 0; s < good.size(); ++s) {
    if (!good[s]) continue;
    const size_t begin = a.first_point[s], end = a.first_point[s + 1], all = a.first_point.back();
    for (size_t key = 0; key < keys.size(); ++key) {
      const auto from = a.points.begin() + static_cast<ptrdiff_t>(4 * (key * all + begin));
      keys[key].insert(keys[key].end(), from, from + static_cast<ptrdiff_t>(4 * (end - begin)));
    }
    kept.first_point.push_back(kept.first_point.back() + static_cast<uint32_t>(end - begin));
    kept.ids.push_back(a.ids[s]);
    if (!a.roots.empty()) kept.roots.push_back(a.roots[s]);
    if (!a.root_uv.empty()) kept.root_uv.push_back(a.root_uv[s]);
    for (size_t i = 0; i < a.attributes.size(); ++i)
      append_values(a.attributes[i], a, s, s + 1, kept.attributes[i]);
  }
  for (const auto& key : keys) kept.points.insert(kept.points.end(), key.begin(), key.end());
  a = std::move(kept);
}

}  // namespace

std::vector<double> RibShutter::keys(size_t samples) const {
  if (samples < 2 || !(times.y > times.x)) return {times.x};
  std::vector<double> keys;
  for (size_t i = 0; i < samples; ++i)
    keys.push_back(times.x +
                   double(times.y - times.x) * static_cast<double>(i) / static_cast<double>(samples - 1));
  return keys;
}

StrandArrays to_world(StrandArrays strands, const std::vector<double>& times, const RibTransform& to_world,
                      const RibShutter& shutter, size_t& dropped) {
  const std::vector<double> keys = shutter.keys(std::max(times.size(), to_world.sample_count()));
  const size_t per_key = size_t(4) * strands.first_point.back();
  std::vector<float> points;
  points.reserve(per_key * keys.size());
  for (const double key : keys) {
    const auto after = std::upper_bound(times.begin(), times.end(), key);
    const size_t high =
        std::min(static_cast<size_t>(after - times.begin()), std::max<size_t>(times.size(), 1) - 1);
    const size_t low = after == times.begin() ? 0 : static_cast<size_t>(after - times.begin()) - 1;
    const float t = high > low ? static_cast<float>((key - times[low]) / (times[high] - times[low])) : 0.0f;
    const float *a = strands.points.data() + low * per_key, *b = strands.points.data() + high * per_key;
    const M44f matrix = to_world.at(key);
    const bool identity = matrix == M44f();
    const float scale = std::cbrt(std::abs(matrix.determinant()));
    for (size_t i = 0; i < per_key; i += 4) {
      V3f p(interpolate(a[i], b[i], t), interpolate(a[i + 1], b[i + 1], t),
            interpolate(a[i + 2], b[i + 2], t));
      if (!identity) p *= matrix;
      const float radius = interpolate(a[i + 3], b[i + 3], t);
      points.insert(points.end(), {p.x, p.y, p.z, identity ? radius : scale * radius});
    }
  }
  strands.points = std::move(points);
  strands.motion_keys = static_cast<int>(keys.size());
  drop_bad(strands, dropped);
  make_finite(strands);
  return strands;
}

RibBatches::Open& RibBatches::open_for(size_t coat, const StrandArrays& strands) {
  for (Open& open : open_) {
    if (open.coat == coat && same_form(open.arrays, strands)) return open;
  }
  Open open{coat, {}, {}};
  open.arrays.basis = strands.basis;
  open.arrays.motion_keys = strands.motion_keys;
  open.arrays.first_point = {0};
  open.keys.resize(static_cast<size_t>(strands.motion_keys));
  for (const StrandAttribute& a : strands.attributes)
    open.arrays.attributes.push_back(
        {a.name, a.frequency, a.components,
         a.frequency == AttributeClass::kConstant ? a.values : std::vector<float>()});
  open_.push_back(std::move(open));
  return open_.back();
}

void RibBatches::append(Open& open, const StrandArrays& from, size_t begin, size_t end) {
  StrandArrays& to = open.arrays;
  const size_t first = from.first_point[begin], last = from.first_point[end], all = from.first_point.back();
  for (size_t key = 0; key < open.keys.size(); ++key) {
    const auto points = from.points.begin() + static_cast<ptrdiff_t>(4 * key * all);
    open.keys[key].insert(open.keys[key].end(), points + static_cast<ptrdiff_t>(4 * first),
                          points + static_cast<ptrdiff_t>(4 * last));
  }
  const uint32_t shift = to.first_point.back();
  for (size_t s = begin; s < end; ++s) {
    to.first_point.push_back(shift + from.first_point[s + 1] - from.first_point[begin]);
    to.ids.push_back(from.ids[s]);
    if (!from.root_uv.empty()) to.root_uv.push_back(from.root_uv[s]);
  }
  for (size_t i = 0; i < from.attributes.size(); ++i)
    append_values(from.attributes[i], from, begin, end, to.attributes[i]);
}

void RibBatches::pass_on(Open& open) {
  for (std::vector<float>& key : open.keys) {
    open.arrays.points.insert(open.arrays.points.end(), key.begin(), key.end());
    std::vector<float>().swap(key);
  }
  take_(open.coat, Strands(std::move(open.arrays)));
}

void RibBatches::add(size_t coat, const StrandArrays& strands) {
  for (size_t begin = 0; begin < strands.ids.size();) {
    Open& open = open_for(coat, strands);
    const size_t end = std::min(strands.ids.size(), begin + kMaxStrands - open.arrays.ids.size());
    append(open, strands, begin, end);
    begin = end;
    if (open.arrays.ids.size() < kMaxStrands) continue;
    Open full = std::move(open);
    open_.erase(open_.begin() + (&open - open_.data()));
    pass_on(full);
  }
}

void RibBatches::finish() {
  for (Open& open : open_) pass_on(open);
  open_.clear();
}

}  // namespace pelage
