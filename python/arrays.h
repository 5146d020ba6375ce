// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>

namespace pelage {

/// Input array: one that already has this type and layout is used as it is, any other is copied.
template <class T>
using InputArray = pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast>;

/// Returns a read-only array that shows memory of `owner` without a copy, and keeps the owner alive. `data`
/// may be null if the array is empty.
template <class T, class Owner>
pybind11::array_t<T> view_of(std::shared_ptr<Owner> owner, const T* data,
                             std::vector<pybind11::ssize_t> shape, std::vector<pybind11::ssize_t> strides) {
  static const T none{};
  auto* keep = new std::shared_ptr<Owner>(std::move(owner));
  const pybind11::capsule capsule(keep, [](void* p) { delete static_cast<std::shared_ptr<Owner>*>(p); });
  pybind11::array_t<T> view(std::move(shape), std::move(strides), data ? data : &none, capsule);
  pybind11::detail::array_proxy(view.ptr())->flags &= ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return view;
}

/// Returns an array that takes over the memory of a vector.
template <class T>
pybind11::array_t<T> array_from(std::vector<T> values, std::vector<pybind11::ssize_t> shape) {
  auto* keep = new std::vector<T>(std::move(values));
  const pybind11::capsule capsule(keep, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return pybind11::array_t<T>(std::move(shape), keep->data(), capsule);
}

}  // namespace pelage
