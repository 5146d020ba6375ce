// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/script_module.h"

#include <cstdio>
#include <cstring>
#include <mutex>
#include <string>

#include <dlfcn.h>
#include <pybind11/pybind11.h>

#include "python/scripts/strand_function.h"

namespace py = pybind11;

/// Lives and dies with the interpreter's lock.
struct PelageScript {
  std::string path;
  py::object module;  ///< scripts/strand_function.py
  py::object script;  ///< its Script
};

namespace pelage {
namespace {

void say(PelageScriptFault* fault, int line, const std::string& message) {
  fault->line = line;
  std::snprintf(fault->message, sizeof fault->message, "%s", message.c_str());
}

/// Modules of Python, such as numpy, look for the interpreter among the symbols that all can see.
void show_symbols() {
  Dl_info library{};
  if (::dladdr(reinterpret_cast<const void*>(&Py_IsInitialized), &library) != 0)
    ::dlopen(library.dli_fname, RTLD_NOW | RTLD_GLOBAL | RTLD_NOLOAD);
}

/// Starts the interpreter unless the process has one, as in a Python program. It never ends. Returns an
/// error, or "".
std::string start_interpreter() {
  static std::once_flag started;
  static std::string problem;
  std::call_once(started, [] {
    if (Py_IsInitialized()) return;
    show_symbols();
    PyConfig config;
    PyConfig_InitPythonConfig(&config);
    config.install_signal_handlers = 0;  // Ctrl-C is Pelage's
    config.parse_argv = 0;
    config.write_bytecode = 0;
    PyStatus status = PyConfig_SetBytesString(&config, &config.program_name, PELAGE_PYTHON);
    if (!PyStatus_Exception(status)) status = Py_InitializeFromConfig(&config);
    PyConfig_Clear(&config);
    if (PyStatus_Exception(status)) {
      problem =
          std::string("Python cannot be started: ") + (status.err_msg ? status.err_msg : "unknown error");
    } else {
      PyEval_SaveThread();  // frees the lock
    }
  });
  return problem;
}

/// Holds the lock of the interpreter.
class Locked {
 public:
  Locked() : state_(PyGILState_Ensure()) {}
  ~Locked() { PyGILState_Release(state_); }
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Describes an exception of Python: its line in the script, its type and text.
void describe(py::error_already_set& error, const py::object& module, const std::string& path,
              PelageScriptFault* fault) {
  try {
    if (error.trace()) PyException_SetTraceback(error.value().ptr(), error.trace().ptr());
    const py::tuple described = module.attr("describe")(error.value(), path);
    say(fault, described[0].cast<int>(), described[1].cast<std::string>());
  } catch (const std::exception& unknown) {
    say(fault, 0, unknown.what());
  }
}

py::module_ helper() {
  py::module_ module = py::reinterpret_steal<py::module_>(PyModule_New("pelage_strand_function"));
  module.attr("__builtins__") = py::module_::import("builtins");
  const py::object code = py::reinterpret_steal<py::object>(
      Py_CompileString(kStrandFunction, "pelage/strand_function.py", Py_file_input));
  if (!code) throw py::error_already_set();
  const py::object dict = module.attr("__dict__");
  const py::object done =
      py::reinterpret_steal<py::object>(PyEval_EvalCode(code.ptr(), dict.ptr(), dict.ptr()));
  if (!done) throw py::error_already_set();
  return module;
}

template <class T>
py::bytes bytes_of(const T* values, size_t count) {
  return {reinterpret_cast<const char*>(values), count * sizeof(T)};
}

py::dict arrays_of(const PelageScriptBatch& batch) {
  const size_t n = batch.strands, points = n * batch.points;
  py::dict arrays;
  arrays["ids"] = bytes_of(batch.ids, n);
  arrays["positions"] = bytes_of(batch.positions, 3 * points);
  arrays["widths"] = bytes_of(batch.widths, points);
  arrays["colors"] = bytes_of(batch.colors, 3 * n * batch.color_rows);
  arrays["roots"] = bytes_of(batch.roots, 3 * n);
  arrays["frames"] = bytes_of(batch.frames, 9 * n);
  arrays["rest_roots"] = bytes_of(batch.rest_roots, 3 * n);
  arrays["rest_frames"] = bytes_of(batch.rest_frames, 9 * n);
  arrays["uv"] = bytes_of(batch.uv, 2 * n);
  arrays["clump"] = bytes_of(batch.clump, n);
  return arrays;
}

/// Copies bytes that have the size of `to`, which the helper has checked.
void take(const py::object& bytes, float* to) {
  if (bytes.is_none()) return;
  char* data = nullptr;
  py::ssize_t size = 0;
  if (PyBytes_AsStringAndSize(bytes.ptr(), &data, &size) != 0) throw py::error_already_set();
  std::memcpy(to, data, static_cast<size_t>(size));
}

}  // namespace
}  // namespace pelage

using namespace pelage;

int pelage_scripts_version() { return PELAGE_SCRIPTS_VERSION; }

PelageScript* pelage_script_open(const char* path, const char* source, const char* function,
                                 const char* arguments, PelageScriptFault* fault) {
  if (const std::string problem = start_interpreter(); !problem.empty()) {
    say(fault, 0, problem);
    return nullptr;
  }
  const Locked lock;
  py::object module;
  try {
    module = helper();
    const py::object script = module.attr("Script")(path, py::bytes(source), function, arguments);
    module.attr("flush")();
    return new PelageScript{path, module, script};
  } catch (py::error_already_set& error) {
    if (module) {
      describe(error, module, path, fault);
    } else {
      say(fault, 0, std::string("Python cannot be used: ") + error.what());
    }
  } catch (const std::exception& error) {
    say(fault, 0, error.what());
  }
  return nullptr;
}

void pelage_script_close(PelageScript* script) {
  if (!Py_IsInitialized()) return;  // Python has ended, and freed everything
  const Locked lock;
  delete script;
}

int pelage_script_run(PelageScript* script, const PelageScriptBatch* batch, PelageScriptFault* fault) {
  const Locked lock;
  try {
    const py::tuple result =
        script->script.attr("run")(batch->strands, batch->points, batch->color_rows,
                                   batch->writes_colors != 0, batch->seed, batch->scale, arrays_of(*batch));
    script->module.attr("flush")();
    take(result[0], batch->new_positions);
    take(result[1], batch->new_widths);
    take(result[2], batch->new_colors);
    return 0;
  } catch (py::error_already_set& error) {
    describe(error, script->module, script->path, fault);
  } catch (const std::exception& error) {
    say(fault, 0, error.what());
  }
  return 1;
}
