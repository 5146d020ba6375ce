// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/operator_scripts.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/memory_sample.h"
#include "base/module.h"

namespace pelage {
namespace {

/// The functions of the module that contains CPython.
class ScriptModule {
 public:
  ScriptModule() : module_("pelage_scripts") {
    decltype(&pelage_scripts_version) version = nullptr;
    find(version, "pelage_scripts_version");
    if (version() != PELAGE_SCRIPTS_VERSION)
      throw Error(ErrorKind::kFailed, "module pelage_scripts belongs to another version of Pelage");
    find(open, "pelage_script_open");
    find(close, "pelage_script_close");
    find(run, "pelage_script_run");
  }

  decltype(&pelage_script_open) open = nullptr;
  decltype(&pelage_script_close) close = nullptr;
  decltype(&pelage_script_run) run = nullptr;

 private:
  template <class Function>
  void find(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(module_.symbol(name));
  }

  Module module_;
};

class PythonFunction final : public StrandScript {
 public:
  PythonFunction(std::shared_ptr<const ScriptModule> module, PelageScript* script, MemoryCharge charge)
      : module_(std::move(module)), script_(script), charge_(std::move(charge)) {}
  ~PythonFunction() override { module_->close(script_); }
  PythonFunction(const PythonFunction&) = delete;
  PythonFunction& operator=(const PythonFunction&) = delete;

  bool run(const PelageScriptBatch& batch, PelageScriptFault& fault) const override {
    return module_->run(script_, &batch, &fault) == 0;
  }

 private:
  std::shared_ptr<const ScriptModule> module_;
  PelageScript* script_;
  MemoryCharge charge_;  // of what the script has loaded
};

class PythonScripts final : public OperatorScripts {
 public:
  std::shared_ptr<const StrandScript> open(const ScriptSource& source, const Job& job) const override {
    const std::string text = read_text_file(source.file, kMaxBytes);
    if (text.find('\0') != std::string::npos)
      throw Error(ErrorKind::kInput, {source.file.string(), 0, 0}, "is not a Python file");
    const int64_t before = resident_memory().anonymous;
    const std::shared_ptr<const ScriptModule> scripts = module();
    PelageScriptFault fault{};
    PelageScript* script = scripts->open(source.file.c_str(), text.c_str(), source.function.c_str(),
                                         source.arguments.c_str(), &fault);
    if (!script) throw Error(ErrorKind::kInput, {source.file.string(), fault.line, 0}, fault.message);
    const int64_t cost = std::max<int64_t>(resident_memory().anonymous - before, 0);
    return std::make_shared<PythonFunction>(scripts, script,
                                            MemoryCharge(job.ledger, MemoryTag::kLibraries, cost));
  }

 private:
  static constexpr size_t kMaxBytes = size_t(16) << 20;

  std::shared_ptr<const ScriptModule> module() const {
    const std::lock_guard lock(mutex_);
    if (!module_) module_ = std::make_shared<const ScriptModule>();
    return module_;
  }

  mutable std::mutex mutex_;
  mutable std::shared_ptr<const ScriptModule> module_;
};

}  // namespace

std::shared_ptr<const OperatorScripts> python_scripts() { return std::make_shared<const PythonScripts>(); }

}  // namespace pelage
