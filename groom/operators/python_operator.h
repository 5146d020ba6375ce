// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/schema.h"
#include "base/value_readers.h"
#include "groom/operators/operator.h"
#include "groom/operators/script_arguments.h"

namespace pelage {

class StrandScript;
struct ScriptBatch;

/// Whether a script sets colours, and how many for each strand.
enum class ScriptColors { kNone, kStrand, kPoint };
/// Where a script sees strands: at rest, or in the pose of the frame.
enum class ScriptSpace { kRest, kPose };

/// Keys of the operator `python`.
struct PythonOperatorParams {
  AssetPath module;
  std::string function;
  float bound = 0;
  std::optional<float> max_width;
  ScriptColors colors = ScriptColors::kNone;
  ScriptSpace space = ScriptSpace::kRest;
  ScriptArguments arguments;
  static const Schema<PythonOperatorParams>& schema();
};

/// Shapes strands with a function of a script (docs/PYTHON.md). prepare() opens the script, and needs
/// PrepareContext::scripts.
///
/// apply() calls the function twice: for the whole batch, and for some of its strands in another order. The
/// results for these strands must be equal, bit for bit. So a function that mixes strands, or that is random,
/// is an error. What the function returns is checked against `bound` and `max_width`. apply() throws Error
/// (kInput), which names the strand.
class PythonOperator final : public OperatorOf<PythonOperatorParams> {
 public:
  static constexpr const char* kName = "python";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override;
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  void run(ScriptBatch& strands, const StrandBatch& batch) const;
  void check_limits(const ScriptBatch& strands) const;
  void check_alone(const ScriptBatch& strands, const StrandBatch& batch) const;
  [[noreturn]] void fail(uint64_t strand, const std::string& what) const;

  std::shared_ptr<const StrandScript> script_;
  SourcePosition position_;
  std::string owner_;
  uint64_t seed_ = 0;
};

template <>
struct EnumNames<ScriptColors> {
  static constexpr const char* names[] = {"none", "strand", "point"};
};
template <>
struct EnumNames<ScriptSpace> {
  static constexpr const char* names[] = {"rest", "pose"};
};

}  // namespace pelage
