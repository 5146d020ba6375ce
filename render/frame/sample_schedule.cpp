// SPDX-License-Identifier: Apache-2.0
#include "render/frame/sample_schedule.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "render/sampling/adaptive_rule.h"

namespace pelage {
namespace {

/// Converts `count`, a real number of any size, to a number of samples.
uint32_t limited(double count, uint32_t min, uint32_t max_samples) {
  return std::max(min, static_cast<uint32_t>(std::clamp(count, 0.0, static_cast<double>(max_samples))));
}

/// Max duration of a pass that is watched, if it can be that short.
constexpr double kWatched_s = 1;

/// Fraction of the pilot that is used to find pixels with any variance.
constexpr uint32_t kProbeShare = 4;

Pilot pilot_of(const Film& film) {
  Pilot pilot{film.width(), film.height(), {}};
  pilot.pixels.reserve(film.moments().size());
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const PixelMoments& moments = film.moments()[pilot.pixels.size()];
      pilot.pixels.push_back({static_cast<float>(moments.mean), static_cast<float>(moments.variance()),
                              film.alpha(x, y) > 0, moments.count});
    }
  }
  return pilot;
}

}  // namespace

SampleSchedule::SampleSchedule(FrameLoop& loop, const RenderParams& params, const Job& job,
                               const Stopwatch& clock, bool stays, FrameWatch* watch)
    : loop_(loop),
      params_(params),
      job_(job),
      clock_(clock),
      watch_(watch),
      refines_(watch && !loop.film().layers().splat),
      in_passes_(stays || params.time_limit > 0 || refines_) {}

void SampleSchedule::tell_watch(int grid) {
  if (watch_) watch_->passed(loop_.film(), {loop_.min_samples(), loop_.mean_samples(), grid, full_});
}

SampleSchedule::End SampleSchedule::refine_region(const FrameLoop::Goal& goal, double deadline_s, int grid) {
  region_seen_ = watch_->region_version();
  const bool at_once = !params_.adaptive && params_.time_limit <= 0;  // whether all counts are known
  if (loop_.mean_samples() == 0 || (at_once && region_seen_ == region_refined_)) return End::kDone;
  region_refined_ = region_seen_;
  const std::optional<PixelBox> region = watch_->region();
  if (!region) return End::kDone;
  const auto columns = static_cast<size_t>(loop_.width());
  const auto is_inside = [&](size_t pixel) {
    const int x = static_cast<int>(pixel % columns), y = static_cast<int>(pixel / columns);
    return x >= region->x0 && x < region->x1 && y >= region->y0 && y < region->y1;
  };
  End end = End::kDone;
  for (uint32_t given = 0, next = 1; end == End::kDone && watch_->region_version() == region_seen_;) {
    const double began = clock_.seconds();
    end = loop_.pass(
        [&](size_t pixel, uint32_t now) {
          if (!is_inside(pixel) || watch_->region_version() != region_seen_) return now;
          return at_once ? next : goal(pixel, now);
        },
        false, deadline_s);
    if (end == End::kCancelled) break;
    if (watch_->region_version() == region_seen_ && end == End::kDone) full_ = *region;
    tell_watch(grid);
    if (!at_once || next == max_samples()) break;
    const double sample_s = std::max(1e-9, clock_.seconds() - began) / (next - given);
    given = next;
    next += std::min(limited(kWatched_s / sample_s, 1, given), max_samples() - given);
  }
  return end;
}

SampleSchedule::End SampleSchedule::pass(const FrameLoop::Goal& goal, bool scattered, double deadline_s,
                                         int grid) {
  const auto is_current = [this] { return !refines_ || watch_->region_version() == region_seen_; };
  while (true) {
    End end = refines_ ? refine_region(goal, deadline_s, grid) : End::kDone;
    if (end != End::kDone) return end;
    end = loop_.pass([&](size_t pixel, uint32_t given) { return is_current() ? goal(pixel, given) : given; },
                     scattered, deadline_s);
    if (end == End::kCancelled) return end;
    if (end == End::kDone && !is_current()) continue;
    tell_watch(grid);
    return end;
  }
}

SampleSchedule::End SampleSchedule::coarse_passes() {
  const auto columns = static_cast<size_t>(loop_.width());
  End end = End::kDone;
  for (int grid = 8; grid > 1 && end == End::kDone; grid /= 2) {
    const auto step = static_cast<size_t>(grid);
    const auto goal = [=](size_t pixel, uint32_t given) {
      const bool chosen = pixel % columns % step == 0 && pixel / columns % step == 0;
      return chosen ? std::max(given, 1u) : given;
    };
    end = pass(goal, true, std::numeric_limits<double>::infinity(), grid);
  }
  return end;
}

double SampleSchedule::deadline() const {
  const bool limited = params_.time_limit > 0 && loop_.min_samples() > 0;
  return limited ? double{params_.time_limit} : std::numeric_limits<double>::infinity();
}

ScheduleEnd SampleSchedule::run() {
  End end = End::kDone;
  if (!params_.adaptive) {
    const auto pixels = static_cast<double>(loop_.traced_count());
    job_.progress.begin("render", pixels * max_samples());
    job_.progress.advance(pixels * loop_.mean_samples());  // of a frame that was restored
    end = uniform(max_samples());
  } else {
    end = two_stage();
  }
  job_.progress.end();
  return {end == End::kCancelled, cut_ || end == End::kOutOfTime};
}

SampleSchedule::End SampleSchedule::uniform(uint32_t samples) {
  End end = refines_ && loop_.mean_samples() == 0 ? coarse_passes() : End::kDone;
  double last_pass_s = 0;  // per sample and pixel
  for (uint32_t given = 0; given < samples && end == End::kDone;) {
    uint32_t next = in_passes_ ? std::min(samples, std::max(1u, 2 * given)) : samples;
    if (params_.time_limit > 0 && given > 0) {
      const double fits = std::max(0.0, (params_.time_limit - clock_.seconds()) / last_pass_s);
      job_.progress.expect(static_cast<double>(loop_.traced_count()) *
                           std::min(static_cast<double>(samples), given + fits));
      if (fits < 1) return End::kOutOfTime;
      if (fits < next - given) next = given + static_cast<uint32_t>(fits);
    }
    if (refines_ && given > 0)
      next = std::min(next, given + limited(kWatched_s / last_pass_s, 1, samples - given));
    const double began = clock_.seconds();
    end = pass([next](size_t, uint32_t) { return next; }, in_passes_ && given == 0, deadline());
    last_pass_s = std::max(1e-9, (clock_.seconds() - began) / (next - given));
    given = next;
  }
  return end;
}

SampleSchedule::End SampleSchedule::pilot() {
  const uint32_t pilot = std::min(max_samples(), static_cast<uint32_t>(params_.adaptive->pilot));
  const uint32_t probe = (pilot + kProbeShare - 1) / kProbeShare;
  job_.progress.begin("pilot", static_cast<double>(loop_.pixel_count()) * pilot);
  End end = uniform(probe);
  if (end == End::kDone) {
    const std::vector<uint8_t> worth = needs_full_pilot(pilot_of(loop_.film()));
    const auto goal = [&](size_t pixel, uint32_t) { return worth[pixel] ? pilot : probe; };
    double expected = 0;
    for (size_t i = 0; i < worth.size(); ++i) expected += goal(i, 0);
    job_.progress.expect(expected);
    end = pass(goal, false, deadline());
  }
  job_.progress.end();
  return end;
}

SampleSchedule::End SampleSchedule::two_stage() {
  End end = pilot();
  std::vector<uint32_t> before(loop_.pixel_count());
  for (size_t i = 0; i < before.size(); ++i) before[i] = loop_.sample_count(i);
  const std::vector<uint32_t> counts = end == End::kDone ? second_stage_counts() : before;
  double missing = 0;
  for (size_t i = 0; i < before.size(); ++i) missing += counts[i] - before[i];
  job_.progress.begin("render", missing);
  for (uint32_t share : {8u, 4u, 2u, 1u}) {
    if (share > 1 && !in_passes_) continue;
    if (end != End::kDone) break;
    const auto goal = [&](size_t pixel, uint32_t) {
      return before[pixel] + (counts[pixel] - before[pixel] + share - 1) / share;
    };
    end = pass(goal, false, deadline());
  }
  return end;
}

std::vector<uint32_t> SampleSchedule::second_stage_counts() {
  const std::vector<float> wanted =
      two_stage_counts(pilot_of(loop_.film()), *params_.adaptive, max_samples());
  const auto count = [&](size_t pixel, double factor) {
    return limited(whole_blocks(std::min<double>(factor * wanted[pixel], max_samples())),
                   loop_.sample_count(pixel), max_samples());
  };
  double factor = 1;
  if (params_.time_limit > 0) {
    const double left = (params_.time_limit - clock_.seconds()) * job_.workers.thread_count();
    const auto cost = [&](double tried) {
      double sum = 0;
      for (size_t i = 0; i < wanted.size(); ++i)
        sum += loop_.cost(i) * (count(i, tried) - loop_.sample_count(i));
      return sum;
    };
    if (cost(1) > left) {
      cut_ = true;
      double low = 0, high = 1;
      for (int step = 0; step < 30; ++step) {
        factor = 0.5 * (low + high);
        (cost(factor) > left ? high : low) = factor;
      }
      factor = low;
    }
  }
  std::vector<uint32_t> counts(wanted.size());
  for (size_t i = 0; i < counts.size(); ++i) counts[i] = count(i, factor);
  return counts;
}

}  // namespace pelage
