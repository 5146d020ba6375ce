// SPDX-License-Identifier: Apache-2.0
#include "render/frame/sample_passes.h"

#include <algorithm>
#include <cmath>
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

/// Fraction of the pilot that is used to find pixels, or tiles, with any variance.
constexpr uint32_t kProbeShare = 4, kTileProbeShare = 2;

Pilot pilot_of(const Film& film) {
  Pilot pilot{film.width(), film.height(), {}};
  pilot.pixels.reserve(film.moments().size());
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const PixelMoments& moments = film.moments()[pilot.pixels.size()];
      pilot.pixels.push_back({static_cast<float>(moments.mean), static_cast<float>(moments.variance()),
                              film.alpha(x, y) > 0, moments.samples});
    }
  }
  return pilot;
}

/// The sample counts of all pixels.
std::vector<uint32_t> counts_of(const Film& film) {
  std::vector<uint32_t> counts;
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) counts.push_back(film.samples(x, y));
  }
  return counts;
}

}  // namespace

SamplePasses::SamplePasses(FrameLoop& loop, const RenderParams& params, const Job& job,
                           const Stopwatch& clock, bool fits, FrameWatch* watch)
    : loop_(loop),
      params_(params),
      job_(job),
      clock_(clock),
      watch_(watch),
      in_passes_(fits || params.time_limit > 0 || (watch && !loop.links_pixels())),
      interrupts_(watch ? [this] {
        return watch_->region_version() != region_seen_ || watch_->pause_version() != pause_seen_;
      } : std::function<bool()>()) {}

int64_t SamplePasses::bytes_needed(const RenderParams& params, int64_t pixels) {
  // The pilot, the wanted, given and final counts, and the parts of the rule.
  constexpr int64_t kPixel = sizeof(PilotPixel) + 3 * sizeof(uint32_t) + 32;
  return params.adaptive ? kPixel * pixels : 0;
}

PassState SamplePasses::state() const {
  return {loop_.min_samples(), loop_.mean_samples(), grid_, coarse_, full_};
}

void SamplePasses::tell_watch() {
  if (watch_) watch_->passed(loop_.film(), state());
}

PassEnd SamplePasses::refine_region(const SampleGoal& goal, double deadline_s) {
  region_seen_ = watch_->region_version();
  const bool known = !params_.adaptive && params_.time_limit <= 0;  // whether all counts are known
  if (grid_ == 0 || (known && region_seen_ == region_refined_)) return PassEnd::kDone;
  std::optional<PixelBox> region = watch_->region();
  if (region) region = intersection(*region, loop_.traced());
  if (!region || region->is_empty()) return PassEnd::kDone;
  const auto take = [&](const SampleGoal& count) {
    const PassEnd end = loop_.pass({count, region, false, deadline_s, interrupts_});
    if (end == PassEnd::kDone) full_ = *region;
    if (end == PassEnd::kDone || end == PassEnd::kOutOfTime) tell_watch();
    return end;
  };
  if (!known) return take(goal);
  uint32_t given = loop_.film().min_samples(*region), step = 1;
  PassEnd end = PassEnd::kDone;
  while (given < max_samples() && end == PassEnd::kDone) {
    const uint32_t next = loop_.pass_end(given, given + step, max_samples());
    const double began = clock_.seconds();
    end = take([next](size_t) { return next; });
    const double sample_s = std::max(1e-9, clock_.seconds() - began) / (next - given);
    given = next;
    step = limited(kWatched_s / sample_s, 1, given);
  }
  if (end == PassEnd::kDone) region_refined_ = region_seen_;
  return end;
}

PassEnd SamplePasses::pass(const SampleGoal& goal, bool scattered, double deadline_s, int grid) {
  while (true) {
    PassEnd end = watch_ ? refine_region(goal, deadline_s) : PassEnd::kDone;
    if (end == PassEnd::kDone) {
      end = loop_.pass({goal, {}, scattered, deadline_s, interrupts_});
      if (end == PassEnd::kDone) grid_ = grid;
      if (end == PassEnd::kDone || end == PassEnd::kOutOfTime) tell_watch();
    }
    if (end != PassEnd::kInterrupted) return end;
    if (watch_->pause_version() == pause_seen_) continue;
    pause_seen_ = watch_->pause_version();
    watch_->paused(loop_.film(), state());
  }
}

PassEnd SamplePasses::coarse_passes() {
  const auto columns = static_cast<size_t>(loop_.film().width());
  PassEnd end = PassEnd::kDone;
  for (int grid = 8; grid > 1 && end == PassEnd::kDone; grid /= 2) {
    const auto step = static_cast<size_t>(grid);
    const auto goal = [=](size_t pixel) {
      return pixel % columns % step == 0 && pixel / columns % step == 0 ? 1u : 0u;
    };
    end = pass(goal, true, std::numeric_limits<double>::infinity(), grid);
  }
  return end;
}

double SamplePasses::deadline() const {
  const bool limited = params_.time_limit > 0 && loop_.min_samples() > 0;
  return limited ? double{params_.time_limit} : std::numeric_limits<double>::infinity();
}

SamplePasses::End SamplePasses::run() {
  PassEnd end = PassEnd::kDone;
  if (params_.adaptive) {
    end = two_stage();
  } else {
    job_.progress.begin("render", loop_.traced_count() * max_samples());
    job_.progress.advance(loop_.traced_count() * loop_.mean_samples());  // of a frame that was restored
    end = uniform(max_samples());
  }
  job_.progress.end();
  return {end == PassEnd::kCancelled, cut_ || end == PassEnd::kOutOfTime};
}

bool SamplePasses::run_coarse() {
  coarse_ = true;
  const ProgressStage stage(job_.progress, "coarse pictures", loop_.traced_count() / 4);
  return coarse_passes() != PassEnd::kCancelled;
}

PassEnd SamplePasses::uniform(uint32_t samples) {
  const bool coarse = watch_ && !loop_.links_pixels() && loop_.mean_samples() == 0;
  PassEnd end = coarse ? coarse_passes() : PassEnd::kDone;
  double last_pass_s = 0;  // per sample and pixel
  for (uint32_t given = 0; given < samples && end == PassEnd::kDone;) {
    uint32_t next = in_passes_ ? std::max(1u, 2 * given) : samples;
    if (watch_ && given > 0)
      next = std::min(next, given + limited(kWatched_s / last_pass_s, 1, samples - given));
    next = loop_.pass_end(given, next, samples);
    if (params_.time_limit > 0 && given > 0) {
      const double fits = std::max(0.0, (params_.time_limit - clock_.seconds()) / last_pass_s);
      job_.progress.expect(loop_.traced_count() * std::min(static_cast<double>(samples), given + fits));
      if (fits < 1) return PassEnd::kOutOfTime;
      if (fits < next - given) next = given + static_cast<uint32_t>(fits);
    }
    const double began = clock_.seconds();
    end = pass([next](size_t) { return next; }, in_passes_ && next == 1, deadline());
    last_pass_s = std::max(1e-9, (clock_.seconds() - began) / (next - given));
    given = next;
  }
  return end;
}

PassEnd SamplePasses::pilot() {
  const uint32_t pilot = std::min(max_samples(), static_cast<uint32_t>(params_.adaptive->pilot));
  const uint32_t share = loop_.links_pixels() ? kTileProbeShare : kProbeShare;
  const uint32_t probe = (pilot + share - 1) / share;
  job_.progress.begin("pilot", loop_.traced_count() * pilot);
  PassEnd end = uniform(probe);
  if (end == PassEnd::kDone) {
    const Pilot probed = pilot_of(loop_.film());
    const std::vector<uint8_t> worth =
        loop_.links_pixels() ? tiles_need_full_pilot(probed, FilmSums::kTileSide) : needs_full_pilot(probed);
    const auto goal = [&](size_t pixel) { return worth[pixel] ? pilot : probe; };
    double expected = 0;
    for (size_t i = 0; i < worth.size(); ++i) expected += goal(i);
    job_.progress.expect(expected);
    end = pass(goal, false, deadline());
  }
  job_.progress.end();
  return end;
}

PassEnd SamplePasses::two_stage() {
  PassEnd end = pilot();
  const std::vector<uint32_t> before = counts_of(loop_.film());
  const std::vector<uint32_t> counts = end == PassEnd::kDone ? second_stage_counts(before) : before;
  double missing = 0;
  for (size_t i = 0; i < before.size(); ++i) missing += counts[i] - before[i];
  job_.progress.begin("render", missing);
  for (uint32_t share : {8u, 4u, 2u, 1u}) {
    if (share > 1 && !in_passes_) continue;
    if (end != PassEnd::kDone) break;
    const auto goal = [&](size_t pixel) {
      return before[pixel] + (counts[pixel] - before[pixel] + share - 1) / share;
    };
    end = pass(goal, false, deadline());
  }
  return end;
}

std::vector<uint32_t> SamplePasses::second_stage_counts(const std::vector<uint32_t>& before) {
  const Pilot known = pilot_of(loop_.film());
  const std::vector<float> wanted =
      loop_.links_pixels()
          ? two_stage_tile_counts(known, FilmSums::kTileSide, *params_.adaptive, max_samples())
          : two_stage_counts(known, *params_.adaptive, max_samples());
  const auto count = [&](size_t pixel, double factor) {
    return limited(whole_blocks(std::min<double>(factor * wanted[pixel], max_samples())), before[pixel],
                   max_samples());
  };
  double factor = 1;
  if (params_.time_limit > 0) {
    const double left = (params_.time_limit - clock_.seconds()) * job_.workers.thread_count();
    const auto cost = [&](double tried) {
      double sum = 0;
      for (size_t i = 0; i < wanted.size(); ++i) sum += loop_.cost(i) * (count(i, tried) - before[i]);
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
