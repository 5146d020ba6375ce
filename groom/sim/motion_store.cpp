// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/motion_store.h"

#include <cmath>
#include <cstring>

namespace pelage {
namespace {

constexpr const char* kMotionKind = "motion";

std::vector<int16_t> rounded(const GuideTurns& turns) {
  std::vector<int16_t> numbers;
  numbers.reserve(turns.size());
  for (const float x : turns) numbers.push_back(static_cast<int16_t>(std::lround(x * 32767)));
  return numbers;
}

std::optional<GuideTurns> turns_of(std::span<const std::byte> bytes, size_t segments) {
  if (bytes.size() != segments * 4 * sizeof(int16_t)) return {};
  std::vector<int16_t> numbers(segments * 4);
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  GuideTurns turns;
  turns.reserve(numbers.size());
  for (const int16_t x : numbers) turns.push_back(static_cast<float>(x) / 32767);
  return turns;
}

}  // namespace

ContentHash MotionStore::key_of(int frame) const {
  return ContentHasher().add(key_).add(kVersion).add(frame).digest();
}

std::filesystem::path MotionStore::file(int frame) const { return store_.file(kMotionKind, key_of(frame)); }

std::optional<FrameMotionData> MotionStore::read(int frame, size_t segments, bool with_state,
                                                 const WarningSink& warn) const {
  const std::optional<StoredFile> file = store_.open(kMotionKind, key_of(frame), warn);
  if (!file) return {};
  FrameMotionData motion;
  std::optional<GuideTurns> half, whole;
  if (file->section_count() == 3) {
    half = turns_of(file->section(0), segments);
    whole = turns_of(file->section(1), segments);
  }
  if (!half || !whole || file->section(2).size() % sizeof(float) != 0) {
    warn(this->file(frame).string() + ": damaged cache file: its guides do not match this coat");
    return {};
  }
  motion.half = std::move(*half);
  motion.whole = std::move(*whole);
  if (with_state) {
    motion.state.resize(file->section(2).size() / sizeof(float));
    std::memcpy(motion.state.data(), file->section(2).data(), file->section(2).size());
  }
  return motion;
}

bool MotionStore::write(int frame, const FrameMotionData& motion, const WarningSink& warn) const {
  ContentStore::Writer writer = store_.writer(kMotionKind, key_of(frame));
  const std::vector<int16_t> half = rounded(motion.half), whole = rounded(motion.whole);
  writer.add(std::span<const int16_t>(half));
  writer.add(std::span<const int16_t>(whole));
  writer.add(std::span<const float>(motion.state));
  return writer.commit(warn);
}

}  // namespace pelage
