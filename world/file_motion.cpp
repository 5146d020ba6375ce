// SPDX-License-Identifier: Apache-2.0
#include "world/file_motion.h"

#include <cmath>

#include <fmt/format.h>

#include "base/job.h"
#include "base/memory_budget.h"
#include "groom/operators/follow.h"
#include "groom/strands/named_strands.h"
#include "world/frames.h"
#include "world/motion_files.h"

namespace pelage {
namespace {

/// Bytes that a point of a guide takes while its frames are read, except for those of the reader.
constexpr size_t kBytesOfReadPoint = 160;

/// Whether a file states roots that lie elsewhere than the guides of the coat: farther than the length of a
/// guide, and than the rounding of the file.
bool is_elsewhere(const V3d& stated, const RodRoot& root, const GuideShape& shape) {
  double length = 0;
  for (size_t i = 0; i + 1 < shape.points.size(); ++i)
    length += (shape.points[i + 1] - shape.points[i]).length();
  return (stated - root.position).length() > length + 1e-5 * root.position.length();
}

}  // namespace

FileMotion::FileMotion(const SceneDescription& scene, const Assets& assets, const MovingCoat& coat,
                       double frame, const Job& job)
    : assets_(assets),
      coat_(coat),
      job_(job),
      own_first_(static_cast<int>(std::floor(frame))),
      own_last_(static_cast<int>(std::ceil(frame))) {
  const size_t guides = coat.groom->guides()->follicles.size();
  const auto [first, last] = whole_frames_around(scene.camera, frame);
  const size_t bytes = (coat.segments() + guides) * kBytesOfReadPoint +
                       static_cast<size_t>(last - first + 1) * coat.segments() * 4 * sizeof(float);
  charge_ =
      reserve(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(bytes), "the guides of " + coat.name);
  const LimitSurface& rest = *assets.skins.at(coat.character.params->parts[coat.part].skin.name).rest;
  shapes_ = groomed_guides(*coat.groom, rest, coat.character.params->transform.scale.at(frame), job);
}

GuideTurns FileMotion::at(int half) {
  // A mistake in all files is reported for the rendered frame.
  if (known_.empty()) at_frame(own_first_);
  const int frame = static_cast<int>(std::floor(0.5 * half));
  const GuideTurns& before = at_frame(frame);
  return half == 2 * frame ? before : blend_turns(before, at_frame(frame + 1), 0.5f);
}

std::filesystem::path FileMotion::file_of(int frame) const {
  return frame_file_name(coat_.params->files.path.string(), frame);
}

int FileMotion::held(int frame) const {
  const auto is_missing = [&](int other) {
    std::error_code failed;
    return !std::filesystem::exists(file_of(other), failed) && !failed;
  };
  while (frame < own_first_ && is_missing(frame)) ++frame;
  while (frame > own_last_ && is_missing(frame)) --frame;
  return frame;
}

const GuideTurns& FileMotion::at_frame(int wanted) {
  const int frame = held(wanted);
  const auto known = known_.find(frame);
  if (known != known_.end()) return known->second;
  if (shapes_.empty()) return known_[frame];
  const Strands strands = read(frame);
  const LimitSurface skin = posed_skin(coat_.character, coat_.part, assets_, frame);
  const std::vector<RodRoot> roots = guide_roots(*coat_.groom, skin, 1);
  check_roots(file_of(frame), strands, roots);
  // Strands that the reader has dropped belong to guides without a shape.
  GuideTurns& turns = known_[frame];
  turns.reserve(4 * coat_.segments());
  size_t strand = 0;
  for (size_t g = 0; g < shapes_.size(); ++g) {
    const bool has_strand = strand < strands.strand_count() && strands.id(strand) == g;
    const uint32_t point = has_strand ? strands.first_point(strand++) : 0;
    const bool follows = has_strand && shapes_[g].has_directions();
    for (uint32_t i = 0; i + 1 < shapes_[g].points.size(); ++i) {
      Imath::Quatd turn;
      if (follows) {
        const V3d groomed = turned(roots[g].frame, shapes_[g].points[i + 1] - shapes_[g].points[i]);
        const V3d now = V3d(strands.point(point + i + 1)) - V3d(strands.point(point + i));
        if (now.length() > 0) turn = smallest_turn(groomed / groomed.length(), now / now.length());
      }
      for (const double c : {turn.v.x, turn.v.y, turn.v.z, turn.r}) turns.push_back(static_cast<float>(c));
    }
  }
  return turns;
}

Strands FileMotion::read(int frame) const {
  const AssetPath file{file_of(frame), coat_.params->files.position};
  StrandReadOptions options;
  options.max_bytes = free_bytes(job_.ledger);
  StrandFile read = read_named_strands(file, options);
  check_strands(file.path, read);
  return std::move(read.strands);
}

void FileMotion::check_strands(const std::filesystem::path& file, const StrandFile& read) const {
  const Strands& strands = read.strands;
  const size_t count = strands.strand_count() + static_cast<size_t>(read.repairs.dropped);
  if (count != shapes_.size()) {
    refuse(file,
           fmt::format("has {} strands, but coat '{}' has {} guides", count, coat_.name, shapes_.size()));
  }
  size_t next = 0;
  for (size_t g = 0; g < shapes_.size(); ++g) {
    const bool is_usable = next < strands.strand_count() && strands.id(next) == g;
    const size_t points = is_usable ? strands.strand_points(next++) : 0;
    if (!shapes_[g].has_directions()) continue;  // such a guide follows its skin
    if (!is_usable) refuse(file, fmt::format("strand {} has no length, or a point that is not finite", g));
    if (points != shapes_[g].points.size()) {
      refuse(file, fmt::format("strand {} has {} points{}, but the guides of coat '{}' have {}", g, points,
                               read.repairs.repaired > 0 ? " that differ from the one before" : "",
                               coat_.name, shapes_[g].points.size()));
    }
  }
}

/// A file with the guides of other places would turn strands at random.
void FileMotion::check_roots(const std::filesystem::path& file, const Strands& strands,
                             const std::vector<RodRoot>& roots) const {
  size_t elsewhere = 0;
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const size_t g = strands.id(s);
    elsewhere += is_elsewhere(V3d(strands.point(strands.first_point(s))), roots[g], shapes_[g]);
  }
  if (2 * elsewhere <= strands.strand_count()) return;
  refuse(file,
         fmt::format("{} of {} strands are farther from their guides than these are long; the guides of "
                     "coat '{}' must be in the order and in the space in which `pelage simulate -o` "
                     "writes them",
                     elsewhere, strands.strand_count(), coat_.name));
}

void FileMotion::refuse(const std::filesystem::path& file, const std::string& why) const {
  throw Error(ErrorKind::kInput, coat_.params->files.position, file.string() + ": " + why);
}

}  // namespace pelage
