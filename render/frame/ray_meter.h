// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "base/process_usage.h"
#include "render/accel/trace_counts.h"
#include "render/frame/ray_statistics.h"

namespace pelage {

enum class RayKind : uint8_t { kCamera, kShadow, kIndirect };

/// The clocks of the calling thread. Reading the CPU clock enters the kernel, which slows the next rays down.
struct ThreadClocks {
  static double wall_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
  static double cpu_s() { return thread_cpu_seconds(); }
};

/// Counts the rays of one thread by kind and estimates their CPU time by kind: measures one ray in kStride
/// and multiplies the mean time by the count of rays. Random numbers do not influence which rays are
/// measured, and measuring changes no result.
///
/// Some rays do not enter the mean:
/// - A ray that may have grown a chunk, because growth is reported separately. The next ray replaces it.
/// - A ray that took longer than kSlow_s. The time that the thread was suspended since begin() or since the
///   last such ray is subtracted. If the rest is still longer, this ray counts once.
template <class Clocks>
class RayMeterOf {
 public:
  /// A prime, because the rays of pixels and tiles repeat in powers of two.
  static constexpr int64_t kStride = 61;
  static constexpr double kSlow_s = 1e-3;

  /// Call on the thread that is going to trace rays.
  void begin() { last_ = {Clocks::wall_s(), Clocks::cpu_s()}; }

  /// Traces one ray: returns the result of `trace`, which adds to `counts`.
  template <class Trace>
  auto measure(RayKind kind, const TraceCounts& counts, const Trace& trace) {
    Kind& of = kinds_[static_cast<size_t>(kind)];
    if (of.rays++ < of.next) return trace();
    const int64_t absent = counts.absent_visits;
    const double began_s = Clocks::wall_s();
    const auto result = trace();
    const double took_s = Clocks::wall_s() - began_s;
    if (counts.absent_visits == absent) {
      of.next = of.rays + kStride - 1;
      if (took_s > kSlow_s) {
        add_slow(took_s, of);
      } else {
        ++of.measured;
        of.measured_s += took_s;
      }
    }
    return result;
  }

  /// Adds time that was spent for many rays of a kind together.
  void add(RayKind kind, double seconds) { kinds_[static_cast<size_t>(kind)].together_s += seconds; }

  RayStatistics counts() const {
    return {rays(RayKind::kCamera), rays(RayKind::kShadow), rays(RayKind::kIndirect)};
  }
  /// Estimated time of all rays of a kind; 0 when none was measured.
  double seconds(RayKind kind) const {
    const Kind& of = kinds_[static_cast<size_t>(kind)];
    const double mean_s = of.measured > 0 ? of.measured_s / static_cast<double>(of.measured) : 0;
    return of.together_s + of.slow_s + mean_s * static_cast<double>(of.rays - of.slow);
  }

  /// Adds the rays of another thread.
  RayMeterOf& operator+=(const RayMeterOf& other) {
    for (size_t i = 0; i < kinds_.size(); ++i) kinds_[i] += other.kinds_[i];
    return *this;
  }

 private:
  struct Kind {
    int64_t rays = 0, next = 0;  // next: number of the ray that is measured next
    int64_t measured = 0, slow = 0;
    double measured_s = 0, slow_s = 0, together_s = 0;

    Kind& operator+=(const Kind& other) {
      rays += other.rays;
      measured += other.measured;
      slow += other.slow;
      measured_s += other.measured_s;
      slow_s += other.slow_s;
      together_s += other.together_s;
      return *this;
    }
  };
  struct Readings {
    double wall_s = 0, cpu_s = 0;
  };
  int64_t rays(RayKind kind) const { return kinds_[static_cast<size_t>(kind)].rays; }

  void add_slow(double took_s, Kind& of) {
    const Readings before = last_;
    begin();
    const double suspended_s = (last_.wall_s - before.wall_s) - (last_.cpu_s - before.cpu_s);
    if (took_s - suspended_s < kSlow_s) return;
    ++of.slow;
    of.slow_s += took_s - suspended_s;
  }

  std::array<Kind, 3> kinds_;
  Readings last_;
};

using RayMeter = RayMeterOf<ThreadClocks>;

}  // namespace pelage
