// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geom/usd/usd_layer.h"

namespace pelage {

/// Returns how many numbers a value of a type has: 3 for point3f, 16 for matrix4d; 0 if the type is not of
/// numbers.
size_t usd_components(std::string_view type);

/// Returns all numbers of a value, which is a single value or an array: `components` numbers per element.
/// Numbers that a float cannot hold become infinite or 0. Throws Error (kInput) with line and column when the
/// text has another form, or an integer has a fraction or is too large.
std::vector<float> usd_floats(const UsdLayer& layer, const UsdText& value, size_t components);
std::vector<double> usd_doubles(const UsdLayer& layer, const UsdText& value, size_t components);
std::vector<int64_t> usd_integers(const UsdLayer& layer, const UsdText& value);
/// Returns how many elements a value has, without storing them.
size_t usd_count(const UsdLayer& layer, const UsdText& value, size_t components);

/// Returns the texts of a token, a string or an array of them.
std::vector<std::string> usd_texts(const UsdLayer& layer, const UsdText& value);

}  // namespace pelage
