// SPDX-License-Identifier: Apache-2.0
// Motion blur (16 steps) and the other eye at 2048 x 1556, a work buffer of 6 x 6 samples a pixel and 20
// layers of three colours, in memory. Yardstick: the machine's memory bandwidth, measured in the same run.
// `Traffic`: the same program with a work buffer of colours, on a band of the picture: bytes that the work
// buffers and the fetching of colours move, counted sample by sample.
#include <chrono>
#include <cstring>

#include <benchmark/benchmark.h>

#include "bench/post_picture.h"
#include "post/box_resolve.h"

namespace pelage {
namespace {

constexpr int kScale = 6, kSteps = 16;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

BenchPicture& picture() {
  static BenchPicture only;
  return only;
}

/// Bytes read and written a second by all workers copying, the best of five.
double bandwidth(const Workers& workers) {
  constexpr size_t kBytes = size_t(256) << 20, kPiece = size_t(1) << 20;
  static std::vector<char> from(kBytes, 1), to(kBytes, 2);
  double best = 0;
  for (int run = 0; run < 5; ++run) {
    const auto start = Clock::now();
    workers.for_each(kBytes / kPiece, 1, [&](WorkRange r) {
      std::memcpy(&to[r.begin * kPiece], &from[r.begin * kPiece], kPiece);
    });
    best = std::max(best, 2.0 * kBytes / seconds_since(start));
  }
  return best;
}

/// Bytes moved if all samples are cleared, drawn and read once per step, plus all colours read and written.
double min_bytes(int steps) {
  const double pixels = double(BenchPicture::kWidth) * BenchPicture::kHeight;
  return pixels * kScale * kScale * sizeof(Sample) * 4 * steps + pixels * BenchPicture::kColors * 8;
}

void report(benchmark::State& state, const Workers& workers, double seconds, int steps) {
  const double measured = bandwidth(workers);
  state.counters["GB_per_s"] = measured / 1e9;
  state.counters["ratio"] = seconds / (min_bytes(steps) / measured);  // to moving those bytes through memory
}

void blur(benchmark::State& state) {
  const Workers workers;
  BenchPicture& p = picture();
  const std::vector<float> times = shutter_times({0.5f, 0, kSteps}, 1);
  LinkLimits limits;
  limits.largest_time = 0.25f;
  const PostLayers layers = p.layers();
  NoProgress progress;
  double seconds = 0;
  for (auto _ : state) {
    const auto start = Clock::now();
    const FlowField field(p.kWidth, p.kHeight, p.motion, p.depth, limits, workers);
    blur_rows({&field, {kScale, 0, 0}, times, p.kWidth, 0, p.kHeight}, layers, {}, workers, progress);
    seconds = seconds_since(start);
  }
  report(state, workers, seconds, kSteps);
}

void stereo(benchmark::State& state) {
  const Workers workers;
  BenchPicture& p = picture();
  const PostLayers layers = p.layers();
  NoProgress progress;
  double seconds = 0;
  for (auto _ : state) {
    const auto start = Clock::now();
    const FlowField field(p.kWidth, p.kHeight, parallax_field(p.depth, {3000, 0.065f, 8}), p.depth,
                          LinkLimits(), workers);
    StereoJob job;
    job.field = &field;
    job.target.scale = kScale;
    job.filter = state.range(0) ? StereoFilter::kBox : StereoFilter::kLanczos;
    job.longest_fill = kFillEverything;
    job.width = p.kWidth;
    job.height = job.last_row = p.kHeight;
    stereo_rows(job, layers, kStripRows, workers, progress);
    seconds = seconds_since(start);
  }
  report(state, workers, seconds, 1);
}

/// The 8-byte buffer, which also counts the bytes that it moves.
class CountingBuffer {
 public:
  CountingBuffer(PixelBox box) : buffer_(box, kScale) {}
  const PixelBox& samples() const { return buffer_.samples(); }
  void put(int y, int x0, int x1, Sample sample) {
    const Sample* row = buffer_.row(y) - samples().x0;
    for (int x = x0; x < x1; ++x) wins += sample.is_nearer_than(row[x]);
    tests += static_cast<size_t>(x1 - x0);
    buffer_.put(y, x0, x1, sample);
  }
  void clear() { buffer_.clear(); }
  const WorkBuffer& buffer() const { return buffer_; }
  size_t tests = 0, wins = 0;

 private:
  WorkBuffer buffer_;
};

/// The former layout of the work buffer: a depth and every colour for each sample.
class ColorBuffer {
 public:
  ColorBuffer(PixelBox box, const PostLayers& layers)
      : layers_(layers), samples_{box.x0 * kScale, box.y0 * kScale, box.x1 * kScale, box.y1 * kScale} {
    const auto count = static_cast<size_t>(samples_.width()) * static_cast<size_t>(samples_.height());
    depth_.resize(count);
    colors_.resize(count * layers.channels.size());
  }
  const PixelBox& samples() const { return samples_; }
  void clear() {
    std::fill(depth_.begin(), depth_.end(), Sample());
    std::fill(colors_.begin(), colors_.end(), 0.0f);
  }
  void put(int y, int x0, int x1, Sample sample) {
    const size_t count = layers_.channels.size();
    for (int x = x0; x < x1; ++x) {
      const size_t i = static_cast<size_t>(y - samples_.y0) * static_cast<size_t>(samples_.width()) +
                       static_cast<size_t>(x - samples_.x0);
      if (!sample.is_nearer_than(depth_[i])) continue;
      depth_[i] = sample;  // counted as its depth alone
      for (size_t c = 0; c < count; ++c)
        colors_[i * count + c] = layers_.channels[c].source.at(sample.x(), sample.y());
    }
  }
  void add_to(std::vector<float>& sums) const {
    const size_t count = layers_.channels.size(), width = static_cast<size_t>(samples_.width());
    for (size_t i = 0; i < depth_.size(); ++i) {
      const size_t pixel = i / width / kScale * (width / kScale) + i % width / kScale;
      for (size_t c = 0; c < count; ++c) sums[pixel * count + c] += colors_[i * count + c];
    }
  }

 private:
  const PostLayers& layers_;
  PixelBox samples_;
  std::vector<Sample> depth_;
  std::vector<float> colors_;
};

/// Draws every step of a piece into `buffer`, calling `seen` after each.
template <class Buffer, class Seen>
void draw_steps(const Warp& warp, const std::vector<float>& times, Buffer& buffer, Seen&& seen) {
  const auto blocks = warp.reaching(buffer.samples(), times.front(), times.back());
  for (const float time : times) {
    buffer.clear();
    for (const auto* block : blocks) {
      if (warp.reaches(*block, buffer.samples(), time)) warp.draw(*block, time, buffer);
    }
    seen();
  }
}

/// Pixels of the source that the pixels of a piece see, each with its own.
size_t sources_seen(const WorkBuffer& buffer, const PixelBox& box) {
  size_t count = 0;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      std::vector<uint32_t> seen;
      for (int j = 0; j < kScale; ++j) {
        for (int i = 0; i < kScale; ++i) {
          const Sample s = buffer.row(y * kScale + j)[x * kScale + i - buffer.samples().x0];
          if (!s.is_empty() && std::find(seen.begin(), seen.end(), s.pixel()) == seen.end())
            seen.push_back(s.pixel());
        }
      }
      count += seen.size();
    }
  }
  return count;
}

void traffic(benchmark::State& state) {
  const Workers workers;
  BenchPicture& p = picture();
  const std::vector<float> times = shutter_times({0.5f, 0, kSteps}, 1);
  LinkLimits limits;
  limits.largest_time = 0.25f;
  const FlowField field(p.kWidth, p.kHeight, p.motion, p.depth, limits, workers);
  const Warp warp(field, {kScale, 0, 0});
  const PostLayers layers = p.layers();
  constexpr int kRows = 64, kFirst = p.kHeight / 2, kColumns = 128, kPieceRows = 16;
  double coordinates = 0, colors = 0, coordinate_seconds = 0, color_seconds = 0;
  for (auto _ : state) {
    const PixelBox band{0, kFirst, p.kWidth, kFirst + kRows};
    double bytes = 0, color_bytes = 0;
    const double channels = static_cast<double>(layers.channels.size());
    for (int y = band.y0; y < band.y1; y += kPieceRows) {
      for (int x = 0; x < p.kWidth; x += kColumns) {
        const PixelBox box{x, y, x + kColumns, y + kPieceRows};
        CountingBuffer buffer(box);
        size_t seen = 0;
        draw_steps(warp, times, buffer, [&] { seen += sources_seen(buffer.buffer(), box); });
        const double samples = double(kColumns) * kPieceRows * kScale * kScale * kSteps;
        const double tests = static_cast<double>(buffer.tests), wins = static_cast<double>(buffer.wins);
        // Bytes of samples that are cleared, tested, overwritten and read; then of colours that are fetched
        // and summed.
        bytes += 8 * (samples + tests + wins + samples) + static_cast<double>(seen) * channels * 12;
        const double all = 4 * (1 + channels);
        color_bytes += all * samples + 4 * tests + wins * (all + 4 * channels) + samples * all +
                       samples / (kScale * kScale) * channels * 8;
      }
    }
    coordinates = bytes;
    colors = color_bytes;
    const auto in_parallel = [&](auto&& work) {
      const auto start = Clock::now();
      workers.for_each(kRows / kPieceRows * (p.kWidth / kColumns), 1, [&](WorkRange r) {
        const int across = p.kWidth / kColumns, i = static_cast<int>(r.begin);
        const int x = i % across * kColumns, y = kFirst + i / across * kPieceRows;
        work(PixelBox{x, y, x + kColumns, y + kPieceRows});
      });
      return seconds_since(start);
    };
    coordinate_seconds = in_parallel([&](const PixelBox& box) {
      WorkBuffer buffer(box, kScale);
      BoxResolve resolve(layers);
      resolve.begin(box, kScale);
      draw_steps(warp, times, buffer, [&] { resolve.add(buffer); });
      resolve.finish();
    });
    color_seconds = in_parallel([&](const PixelBox& box) {
      ColorBuffer buffer(box, layers);
      std::vector<float> sums(static_cast<size_t>(kColumns * kPieceRows) * layers.channels.size());
      draw_steps(warp, times, buffer, [&] { buffer.add_to(sums); });
      benchmark::DoNotOptimize(sums.data());
    });
  }
  state.counters["GB"] = coordinates / 1e9;
  state.counters["GB_colours"] = colors / 1e9;
  state.counters["less"] = colors / coordinates;
  state.counters["faster"] = color_seconds / coordinate_seconds;
}

BENCHMARK(blur)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(1)
    ->Repetitions(3)
    ->Name("MotionBlur16Steps");
BENCHMARK(stereo)
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(1)
    ->Repetitions(3)
    ->Name("Stereo/box");
BENCHMARK(traffic)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1)->Name("Traffic");

}  // namespace
}  // namespace pelage

BENCHMARK_MAIN();
