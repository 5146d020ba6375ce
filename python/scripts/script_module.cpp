// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/script_module.h"

#include <cstdio>
#include <cstring>
#include <mutex>
#include <string>
#include <utility>

#include <Python.h>
#include <dlfcn.h>

#include "python/scripts/strand_function.h"

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

/// Owns a reference to an object; null after an exception of Python. The thread holds the lock.
class Object {
 public:
  explicit Object(PyObject* owned = nullptr) : object_(owned) {}
  ~Object() { Py_XDECREF(object_); }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  PyObject* get() const { return object_; }
  explicit operator bool() const { return object_ != nullptr; }
  PyObject* release() { return std::exchange(object_, nullptr); }

 private:
  PyObject* object_;
};

/// Returns the present exception as an object that has its traceback, and clears it.
PyObject* take_exception() {
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  if (value && trace) PyException_SetTraceback(value, trace);
  Py_XDECREF(type);
  Py_XDECREF(trace);
  return value;
}

/// Describes the present exception: its line in the script, its type and text. `module`: the helper, or null.
void describe(PyObject* module, const char* path, PelageScriptFault* fault) {
  const Object error(take_exception());
  say(fault, 0, "Python fails");
  if (!error) return;
  if (module) {
    const Object described(PyObject_CallMethod(module, "describe", "Os", error.get(), path));
    const char* text = nullptr;
    int line = 0;
    if (described && PyArg_ParseTuple(described.get(), "is", &line, &text)) return say(fault, line, text);
  } else {
    const Object text(PyObject_Str(error.get()));
    const char* message = text ? PyUnicode_AsUTF8(text.get()) : nullptr;
    if (message) say(fault, 0, std::string("Python cannot be used: ") + message);
  }
  PyErr_Clear();
}

/// Returns the module of strand_function.py, or null.
PyObject* helper() {
  Object module(PyModule_New("pelage_strand_function"));
  if (!module || PyModule_AddObjectRef(module.get(), "__builtins__", PyEval_GetBuiltins()) != 0)
    return nullptr;
  const Object code(Py_CompileString(kStrandFunction, "pelage/strand_function.py", Py_file_input));
  if (!code) return nullptr;
  PyObject* names = PyModule_GetDict(module.get());
  const Object done(PyEval_EvalCode(code.get(), names, names));
  return done ? module.release() : nullptr;
}

template <class T>
bool add_bytes(PyObject* arrays, const char* name, const T* values, size_t count) {
  const Object bytes(PyBytes_FromStringAndSize(reinterpret_cast<const char*>(values),
                                               static_cast<Py_ssize_t>(count * sizeof(T))));
  return bytes && PyDict_SetItemString(arrays, name, bytes.get()) == 0;
}

/// Returns a dict of the arrays of a batch, or null.
PyObject* arrays_of(const PelageScriptBatch& batch) {
  const size_t n = batch.strands, points = n * batch.points;
  Object arrays(PyDict_New());
  PyObject* to = arrays.get();
  const bool good =
      to && add_bytes(to, "ids", batch.ids, n) && add_bytes(to, "positions", batch.positions, 3 * points) &&
      add_bytes(to, "widths", batch.widths, points) &&
      add_bytes(to, "colors", batch.colors, 3 * n * batch.color_rows) &&
      add_bytes(to, "roots", batch.roots, 3 * n) && add_bytes(to, "frames", batch.frames, 9 * n) &&
      add_bytes(to, "rest_roots", batch.rest_roots, 3 * n) &&
      add_bytes(to, "rest_frames", batch.rest_frames, 9 * n) && add_bytes(to, "uv", batch.uv, 2 * n) &&
      add_bytes(to, "clump", batch.clump, n);
  return good ? arrays.release() : nullptr;
}

/// Copies bytes that have the size of `to`, which the helper has checked; None: keeps `to`.
void take(PyObject* bytes, float* to) {
  if (PyBytes_Check(bytes))
    std::memcpy(to, PyBytes_AS_STRING(bytes), static_cast<size_t>(PyBytes_GET_SIZE(bytes)));
}

}  // namespace
}  // namespace pelage

using namespace pelage;

struct PelageScript {
  std::string path;
  PyObject* module;  ///< strand_function.py
  PyObject* script;  ///< its Script
};

int pelage_scripts_version() { return PELAGE_SCRIPTS_VERSION; }

PelageScript* pelage_script_open(const char* path, const char* source, const char* function,
                                 const char* arguments, PelageScriptFault* fault) {
  if (const std::string problem = start_interpreter(); !problem.empty()) {
    say(fault, 0, problem);
    return nullptr;
  }
  const Locked lock;
  Object module(helper());
  Object script(module
                    ? PyObject_CallMethod(module.get(), "Script", "syss", path, source, function, arguments)
                    : nullptr);
  if (!script) {
    describe(module.get(), path, fault);
    return nullptr;
  }
  return new PelageScript{path, module.release(), script.release()};
}

void pelage_script_close(PelageScript* script) {
  if (!Py_IsInitialized()) return;  // Python has ended, and freed everything
  const Locked lock;
  Py_DECREF(script->script);
  Py_DECREF(script->module);
  delete script;
}

int pelage_script_run(PelageScript* script, const PelageScriptBatch* batch, PelageScriptFault* fault) {
  const Locked lock;
  const Object arrays(arrays_of(*batch));
  const Object result(
      arrays ? PyObject_CallMethod(script->script, "run", "nnniKfO", static_cast<Py_ssize_t>(batch->strands),
                                   static_cast<Py_ssize_t>(batch->points),
                                   static_cast<Py_ssize_t>(batch->color_rows), batch->writes_colors,
                                   static_cast<unsigned long long>(batch->seed),
                                   static_cast<double>(batch->scale), arrays.get())
             : nullptr);
  if (!result) {
    describe(script->module, script->path.c_str(), fault);
    return 1;
  }
  take(PyTuple_GET_ITEM(result.get(), 0), batch->new_positions);
  take(PyTuple_GET_ITEM(result.get(), 1), batch->new_widths);
  take(PyTuple_GET_ITEM(result.get(), 2), batch->new_colors);
  return 0;
}
