// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <pybind11/stl.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_job.h"
#include "python/values.h"
#include "render/fibre/fibre_material.h"

namespace py = pybind11;

namespace pelage {
namespace {

/// A fibre along +x with a constant colour.
struct Fibre {
  FibreMaterial material;
  Rgb color;

  FibreBsdf at(const float* wo, float h) const {
    const V3f tangent(1, 0, 0);
    return material.at({{tangent, tangent, tangent}, V3f(wo[0], wo[1], wo[2]), h, color});
  }
};

void write(const Rgb& value, float* out) {
  for (int c = 0; c < 3; ++c) out[c] = value[c];
}

std::shared_ptr<Fibre> make_fibre(const py::dict& values, py::object callback) {
  const Value block = to_value(values, "");
  MaterialParams params;
  Problems problems;
  ValueReader<MaterialParams>::read(block, {}, params, problems);
  problems.throw_if_any();
  const FibreParams* fibre = fibre_params(params);
  if (!fibre)
    throw Error(ErrorKind::kArguments, {"model", 0, 0}, "expected the model of a fibre, not of a skin");
  if (!fibre->color.is_constant())
    throw Error(ErrorKind::kArguments, {"color", 0, 0}, "expected a constant colour");
  const Rgb color = fibre->color.color({});
  PythonProgress progress(std::move(callback));
  std::shared_ptr<Fibre> made;
  run_job(progress, [&] {
    const Workers workers;
    MemoryLedger ledger;
    const Job job{workers, ledger, progress};
    made = std::make_shared<Fibre>(Fibre{FibreMaterial(with_tables(params, job)), color});
  });
  return made;
}

// Arrays: wo and wi (n, 3), h (n), u (n, 3); pelage/_fibre.py has checked their shapes and values.

py::tuple evaluate(const Fibre& fibre, const InputArray<float>& wo, const InputArray<float>& wi,
                   const InputArray<float>& h) {
  const auto n = static_cast<size_t>(h.size());
  std::vector<float> values(n * kLobeGroups * 3), pdf(n);
  const float *out = wo.data(), *in = wi.data(), *across = h.data();
  {
    const py::gil_scoped_release release;
    for (size_t i = 0; i < n; ++i) {
      const FibreValue value =
          fibre.at(out + 3 * i, across[i]).eval({in[3 * i], in[3 * i + 1], in[3 * i + 2]});
      for (size_t g = 0; g < kLobeGroups; ++g) write(value.lobes[g], &values[(i * kLobeGroups + g) * 3]);
      pdf[i] = value.pdf;
    }
  }
  const auto rows = static_cast<py::ssize_t>(n);
  return py::make_tuple(array_from(std::move(values), {rows, kLobeGroups, 3}),
                        array_from(std::move(pdf), {rows}));
}

/// wi, rho and pdf; all 0 where the fibre scatters nothing.
py::tuple sample(const Fibre& fibre, const InputArray<float>& wo, const InputArray<float>& h,
                 const InputArray<float>& u) {
  const auto n = static_cast<size_t>(h.size());
  std::vector<float> wi(n * 3), rho(n * 3), pdf(n);
  const float *out = wo.data(), *across = h.data(), *random = u.data();
  {
    const py::gil_scoped_release release;
    for (size_t i = 0; i < n; ++i) {
      const auto drawn =
          fibre.at(out + 3 * i, across[i]).sample({random[3 * i], random[3 * i + 1], random[3 * i + 2]});
      if (!drawn) continue;
      for (int c = 0; c < 3; ++c) wi[3 * i + static_cast<size_t>(c)] = drawn->wi[c];
      write(drawn->value.total(), &rho[3 * i]);
      pdf[i] = drawn->value.pdf;
    }
  }
  const auto rows = static_cast<py::ssize_t>(n);
  return py::make_tuple(array_from(std::move(wi), {rows, 3}), array_from(std::move(rho), {rows, 3}),
                        array_from(std::move(pdf), {rows}));
}

py::array_t<float> albedo(const Fibre& fibre, const InputArray<float>& wo, const InputArray<float>& h) {
  const auto n = static_cast<size_t>(h.size());
  std::vector<float> values(n * 3);
  for (size_t i = 0; i < n; ++i) write(fibre.at(wo.data() + 3 * i, h.data()[i]).albedo(), &values[3 * i]);
  return array_from(std::move(values), {static_cast<py::ssize_t>(n), 3});
}

}  // namespace

void bind_fibre(py::module_& module) {
  py::class_<Fibre, std::shared_ptr<Fibre>>(module, "Fibre")
      .def("evaluate", evaluate)
      .def("sample", sample)
      .def("albedo", albedo)
      .def_property_readonly("far_field", [](const Fibre& f) { return f.material.far_field(); });
  module.def("make_fibre", make_fibre);
  module.attr("lobe_groups") = py::make_tuple(kLobeGroupNames[0], kLobeGroupNames[1], kLobeGroupNames[2]);
}

}  // namespace pelage
