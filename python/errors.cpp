// SPDX-License-Identifier: Apache-2.0
#include "python/errors.h"

#include <pybind11/stl.h>

#include "base/error.h"
#include "base/nearest_name.h"

namespace py = pybind11;

namespace pelage {
namespace {

const char* kind_name(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kFailed:
      return "failed";
    case ErrorKind::kArguments:
      return "arguments";
    case ErrorKind::kInput:
      return "input";
    case ErrorKind::kMemory:
      return "memory";
    case ErrorKind::kStopped:
      return "stopped";
  }
  return "failed";
}

void set_error(const Error& error) {
  py::list problems;
  for (const Problem& problem : error.problems()) {
    problems.append(py::make_tuple(problem.position.file, problem.position.line, problem.position.column,
                                   problem.message));
  }
  const py::module_ errors = py::module_::import("pelage._errors");
  const py::object type = errors.attr(error.kind() == ErrorKind::kStopped ? "Cancelled" : "Error");
  const py::object instance = type(problems, kind_name(error.kind()));
  PyErr_SetObject(type.ptr(), instance.ptr());
}

}  // namespace

void register_errors(py::module_& module) {
  module.def("suggest", [](const std::string& name, const std::vector<std::string>& names) {
    return suggest(name, names);
  });
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      set_error(error);
    }
  });
}

}  // namespace pelage
