// SPDX-License-Identifier: Apache-2.0
#include "groom/coat/attachment.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/job.h"
#include "base/progress_stage.h"
#include "groom/coat/groom_params.h"
#include "groom/strands/skin_binding.h"

namespace pelage {

SkinGaps SkinGaps::of(std::vector<float>& gaps, const Box3f& skin) {
  SkinGaps result;
  result.skin_size = skin.isEmpty() ? 0 : skin.size().length();
  if (gaps.empty()) return result;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  result.min = *std::min_element(gaps.begin(), middle + 1);
  result.median = *middle;
  result.max = *std::max_element(middle, gaps.end());
  return result;
}

std::string SkinGaps::describe(const std::string& skin) const {
  return fmt::format("begin {:.3g} to {:.3g} units from skin '{}', which is {:.3g} units across", min, max,
                     skin, skin_size);
}

bool follow_skin(const GroomParams& params, const LimitSurface& rest, const Job& job,
                 std::vector<V3f>& positions, std::vector<RootAddress>& roots) {
  if (params.attach == Attachment::kNone) return false;
  const SkinBinding binding(rest, params.strands_file.path, job);
  const auto stay = [&](const std::string& why) {
    job.progress.warn(to_string(params.strands_file.position) + ": the strands of " +
                      params.strands_file.path.filename().string() + " " + why +
                      "; they keep their positions from the file and do not follow the skin (attach: skin "
                      "makes them follow it; attach: none silences this warning)");
    std::fill(roots.begin(), roots.end(), RootAddress{});
    return false;
  };
  if (binding.empty()) {
    if (params.attach == Attachment::kAuto)
      return stay("have no skin to follow, because all its faces are holes");
    throw Error(ErrorKind::kInput, params.strands_file.position,
                "attach: skin needs a skin with at least one face that is not a hole");
  }
  const auto place = [&](size_t i) { return rest.evaluate(roots[i].face, roots[i].u, roots[i].v).position; };
  std::vector<float> gaps(positions.size());
  constexpr size_t kMinForProgress = 50'000;  // a strand takes some 10 us
  const ProgressStage stage(job.progress, "bind strands", static_cast<double>(positions.size()),
                            positions.size() >= kMinForProgress);
  job.for_each(positions.size(), 256, [&](WorkRange range) {
    stage.advance(static_cast<double>(range.end - range.begin));
    for (size_t i = range.begin; i < range.end; ++i) {
      roots[i] = binding.nearest(positions[i]);
      gaps[i] = (place(i) - positions[i]).length();
    }
  });
  const SkinGaps all = SkinGaps::of(gaps, rest.control_bounds());
  if (params.attach == Attachment::kAuto && all.far()) return stay(all.describe(params.skin.name));
  job.for_each(positions.size(), 4096, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) positions[i] = place(i);
  });
  return true;
}

}  // namespace pelage
