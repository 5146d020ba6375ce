// SPDX-License-Identifier: Apache-2.0
#include "geom/io/strand_formats.h"
#include "geom/usd/usd_curves_file.h"
#include "geom/usd/usd_curves_writer.h"

namespace pelage {

std::unique_ptr<RawStrands> open_usd(const std::filesystem::path& path, const StrandReadOptions& options) {
  return std::make_unique<HeldStrands>(path, "usd", read_usd_curves(path, {options.max_bytes}));
}

void write_usd(const std::filesystem::path& path, const Strands& strands, bool widths) {
  UsdWriter usd(path, "defaultPrim = \"hair\"\nupAxis = \"Y\"", Links::kFollow);
  UsdCurvesFacts facts;
  facts.widths = widths;
  write_usd_curves(usd, "hair", facts, 1, [&](size_t) {
    UsdCurvesSample sample{strands, {}};
    for (int key = 0; key < strands.motion_keys() && strands.motion_keys() > 1; ++key)
      sample.times.push_back(key);
    return sample;
  });
  usd.commit();
}

}  // namespace pelage
