// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/experiments.h"
#include "lab/measure/lod_cases.h"
#include "lab/measure/lod_crowd.h"
#include "lab/measure/lod_pictures.h"
#include "lab/pictures/picture_error.h"
#include "lab/pictures/systematic_error.h"
#include "lab/runs/outcome_table.h"

namespace pelage {
namespace {

constexpr const char *kCrowd = "crowd", *kDetail = "detail", *kWedge = "wedge", *kDolly = "dolly";
// Parts of a dolly: positions of the LOD camera, relative to its distance, and the increment per frame, as in
// a dolly over 230 frames to ten times the distance.
constexpr double kDollyPlaces[] = {0.25, 0.5, 1};
constexpr double kDollyStep = 1.01;
constexpr int kSheetWidth = 320;
constexpr size_t kSheetRows = 3;

/// The reference of a variant, as index of its outcomes; -1: it is full detail itself.
struct Row {
  std::string part;
  int full = -1;
  PictureError error = {};
  bool known = false;
  SystematicError systematic = {};
};

Variant variant_of(const std::string& id, const std::string& title, const Settings& settings, bool enabled,
                   size_t seed) {
  Variant variant{id, title, "render", {}};
  const auto set = [&](const std::string& key, const std::string& value) {
    variant.arguments.insert(variant.arguments.end(), {"--set", key + "=" + value});
  };
  for (const auto& [key, value] : settings) set(key, value);
  set("render.lod.enabled", enabled ? "true" : "false");
  set("render.seed", std::to_string(2000 + seed));
  set("image.light_layers", "false");
  set("image.lod_layer", "true");
  return variant;
}

std::string dolly_id(double factor) { return fmt::format("dolly-{:.5g}", factor); }

Settings both(Settings a, const Settings& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class LodSweep {
 public:
  LodSweep(const SceneDescription& scene, const std::vector<std::string>& parts, const MeasureSetup& setup,
           Progress& progress)
      : crowd(scene, setup),
        scene_(scene),
        parts_(parts),
        places_(lod_places(scene)),
        progress_(progress),
        runner_(setup, progress, count()) {}

  /// Runs until one fails.
  void run() {
    if (wanted(kCrowd) && !scene_.crowds.items.empty()) {
      crowd.run([&](const Variant& variant) {
        return run_one(variant, {kCrowd, -1, {}, false}) ? &outcomes.back() : nullptr;
      });
    }
    if (!ended() && wanted(kDetail)) compare_details();
    if (!ended() && wanted(kWedge)) fill_sheet();
    if (!ended() && wanted(kDolly)) move_away();
  }

  std::vector<Outcome> outcomes;
  std::vector<Row> rows;
  LodCrowd crowd;

  const std::vector<LodPlace>& places() const { return places_; }
  const Outcome* find(const std::string& id) const {
    const auto at = std::find_if(outcomes.begin(), outcomes.end(),
                                 [&](const Outcome& o) { return o.variant.id == id && o.succeeded(); });
    return at == outcomes.end() ? nullptr : &*at;
  }
  std::filesystem::path picture(const Outcome& outcome) const { return runner_.picture(outcome.variant); }

 private:
  bool wanted(const char* part) const {
    return parts_.empty() || std::find(parts_.begin(), parts_.end(), part) != parts_.end();
  }
  bool ended() const { return progress_.cancelled() || (!outcomes.empty() && !outcomes.back().succeeded()); }
  size_t count() const {
    return (wanted(kCrowd) && !scene_.crowds.items.empty() ? LodCrowd::kVariants : 0) +
           (wanted(kDetail) ? 4 * places_.size() + 2 * lod_ideas().size() : 0) +
           (wanted(kWedge) ? kSheetRows * lod_qualities().size() : 0) +
           (wanted(kDolly) ? 2 * std::size(kDollyPlaces) : 0);
  }

  void compare_details() {
    for (const LodPlace& place : places_) {
      const int full = add_pair(place, {"full", "full detail", {}, false}, -1);
      if (full < 0) return;
      const bool first = &place == &places_.front();
      if (first && add_pair(place, other_hairs(scene_), full) < 0) return;
      for (const LodSetting& idea : lod_ideas()) {
        if (!first && idea.id != "all") break;
        if (add_pair(place, idea, full) < 0) return;
      }
    }
  }
  void fill_sheet() {
    for (size_t place = 0; place < kSheetRows; ++place) {
      for (const LodSetting& quality : lod_qualities()) {
        if (!add_single(places_[place], quality)) return;
      }
    }
  }
  void move_away() {
    for (const double place : kDollyPlaces) {
      for (const double factor : {place, place * kDollyStep}) {
        // One seed: where the scene does not change, the picture does not either.
        const Variant variant =
            variant_of(dolly_id(factor), fmt::format("dolly, {:.5g} of the distance", factor),
                       detail_camera(scene_, static_cast<float>(factor)), true, 0);
        if (!run_one(variant, {kDolly, -1, {}, false})) return;
      }
    }
  }

  bool run_one(const Variant& variant, const Row& row) {
    outcomes.push_back(runner_.run(variant));
    rows.push_back(row);
    return outcomes.back().succeeded() && !progress_.cancelled();
  }

  /// Two pictures with their own seeds, so that noise cancels. Returns the index of the first, or -1.
  int add_pair(const LodPlace& place, const LodSetting& setting, int full) {
    const auto first = static_cast<int>(outcomes.size());
    for (const char* which : {"a", "b"}) {
      const Variant variant = variant_of(fmt::format("{}-{}-{}", place.id, setting.id, which),
                                         fmt::format("{}, {} ({})", place.title, setting.title, which),
                                         both(place.view, setting.lod), setting.reduced, outcomes.size());
      if (!run_one(variant, {kDetail, full, {}, false})) return -1;
    }
    if (full >= 0) {
      const auto at = [&](int i) { return runner_.picture(outcomes[static_cast<size_t>(i)].variant); };
      const auto error =
          picture_error_of_files(at(first), at(first + 1), at(full), at(full + 1), ErrorRegion::kSurfaces);
      const auto systematic =
          systematic_error_of_files(at(first), at(first + 1), at(full), at(full + 1), ErrorRegion::kSurfaces);
      for (size_t i = static_cast<size_t>(first); i < outcomes.size(); ++i) {
        rows[i].known = error.has_value();
        rows[i].error = error.value_or(PictureError{});
        rows[i].systematic = systematic.value_or(SystematicError{});
      }
    }
    return first;
  }

  bool add_single(const LodPlace& place, const LodSetting& setting) {
    const Variant variant = variant_of(fmt::format("sheet-{}-{}", place.id, setting.id),
                                       fmt::format("{}, {}", place.title, setting.title),
                                       both(place.view, setting.lod), true, outcomes.size());
    return run_one(variant, {kWedge, -1, {}, false});
  }

  const SceneDescription& scene_;
  const std::vector<std::string>& parts_;
  const std::vector<LodPlace> places_;
  Progress& progress_;
  VariantRunner runner_;
};

/// Distances by qualities.
std::optional<Picture> sheet_of(const LodSweep& sweep) {
  std::vector<std::filesystem::path> tiles;
  const auto qualities = lod_qualities();
  for (size_t row = 0; row < kSheetRows; ++row) {
    for (const LodSetting& quality : qualities) {
      const Outcome* outcome = sweep.find(fmt::format("sheet-{}-{}", sweep.places()[row].id, quality.id));
      if (!outcome) return {};
      tiles.push_back(sweep.picture(*outcome));
    }
  }
  return picture_sheet(tiles, qualities.size(), kSheetWidth,
                       "Distance (1, 2, 4 times that of the scene, from top to bottom) by `quality` (0.5, 1, "
                       "2, 4).");
}

Table dolly_table(const LodSweep& sweep) {
  Table table;
  table.caption = fmt::format(
      "Change of the picture when the camera of the level of detail moves away by {:.3g} % from fractions of "
      "its distance, while the rendering camera stays. Differences of luminance relative to its mean: the "
      "maximum of a pixel, the maximum of the mean over {} x {} pixels, and the root mean square. Noise is "
      "the difference between two seeds.",
      100 * (kDollyStep - 1), kChangeBlock, kChangeBlock);
  table.columns = {{"from", "from", Quantity::kRatio},
                   {"hairs_before", "hairs", Quantity::kRatio},
                   {"hairs_after", "hairs then", Quantity::kRatio},
                   {"largest", "largest", Quantity::kPercent},
                   {"largest_block", "of a block", Quantity::kPercent},
                   {"rms", "rms", Quantity::kPercent}};
  const auto add = [&](const std::string& name, const Outcome* from, const Outcome* to) {
    if (!from || !to) return;
    const PictureChange change = change_between(sweep.picture(*from), sweep.picture(*to));
    table.rows.push_back({Text{name}, from->number("strands_generated"), to->number("strands_generated"),
                          change.largest, change.largest_block, change.rms});
  };
  for (const double place : kDollyPlaces)
    add(fmt::format("{:g} of the distance", place), sweep.find(dolly_id(place)),
        sweep.find(dolly_id(place * kDollyStep)));
  add("noise, for comparison", sweep.find("here-all-a"), sweep.find("here-all-b"));
  return table;
}

void add_detail(const LodSweep& sweep, Report& report) {
  report.sections.push_back(
      {"Method",
       {Paragraph{
           "Every view of the scene is rendered twice with full detail and twice with reduced detail, "
           "all four with different seeds: x, y and a, b. relMSE is the mean over pixels with alpha "
           "of (x - a)(y - b) / (t^2 + 0.01 m^2), where t is the mean of a and b over 9 x 9 pixels "
           "and m its mean over these pixels: the error common to both pictures, without noise; of 4 x 4 and "
           "16 x 16: of means of so many pixels. Off: the root of the mean of (x - a)(y - b) / (t^2 + 0.01 "
           "m^2) "
           "over means of 8 x 8 or 32 x 32 pixels, and the error of the worst block. Bias is "
           "the error of the mean luminance over these pixels. Fractions are relative to full detail "
           "from the same place. Naive thinning removes the same strands and does not widen the "
           "others. Other hairs: the same coats with another seed, at full detail."}}});
  Table details = select(report.data,
                         {"variant", "wall_s", "cpu_s", "cpu_least_s", "cpu_most_s", "hairs", "hairs_share",
                          "working_set_bytes", "set_share", "cpu_share", "rel_mse", "rel_mse_4", "rel_mse_16",
                          "systematic_8", "worst_8", "systematic_32", "worst_32", "bias"},
                         "By place and idea; each place twice.");
  Table table = details;
  table.rows.clear();
  for (size_t i = 0; i < sweep.rows.size(); ++i) {
    if (sweep.rows[i].part == kDetail) table.rows.push_back(std::move(details.rows[i]));
  }
  report.sections.push_back({"Detail", {std::move(table)}});
  if (const Outcome* outcome = sweep.find("here-all-a")) {
    if (auto colours = detail_picture(sweep.picture(*outcome)))
      report.sections.push_back({"Where", {std::move(*colours)}});
  }
}

}  // namespace

Measured measure_lod(const SceneDescription& scene, const std::vector<std::string>& parts,
                     const MeasureSetup& setup, Progress& progress) {
  LodSweep sweep(scene, parts, setup, progress);
  sweep.run();
  Measured measured;
  measured.outcomes = std::move(sweep.outcomes);
  sweep.outcomes = measured.outcomes;
  const std::vector<Outcome>& outcomes = measured.outcomes;
  Report& report = measured.report;
  report.title = "Level of detail";
  report.data = outcome_table(outcomes);
  const auto add = [&](const char* key, const char* title, Quantity quantity, const auto& value) {
    add_column(report.data, {key, title, quantity}, outcomes, [&](const Outcome& o) -> Cell {
      const auto i = static_cast<size_t>(&o - outcomes.data());
      return value(o, sweep.rows[i]);
    });
  };
  add("hairs", "hairs grown", Quantity::kRatio,
      [](const Outcome& o, const Row&) { return o.number("strands_generated"); });
  const auto share = [&](const char* number) {
    return [&, number](const Outcome& o, const Row& row) {
      return row.full < 0 ? NAN : o.number(number) / outcomes[static_cast<size_t>(row.full)].number(number);
    };
  };
  add("hairs_share", "of full", Quantity::kPercent, share("strands_generated"));
  add("set_share", "working set", Quantity::kPercent, share("working_set_bytes"));
  add("cpu_share", "CPU time", Quantity::kPercent, share("cpu_s"));
  add("rel_mse", "relMSE", Quantity::kRatio,
      [](const Outcome&, const Row& row) { return row.known ? row.error.rel_mse : NAN; });
  add("rel_mse_4", "of 4 x 4", Quantity::kRatio,
      [](const Outcome&, const Row& row) { return row.known ? row.error.rel_mse_4 : NAN; });
  add("rel_mse_16", "of 16 x 16", Quantity::kRatio,
      [](const Outcome&, const Row& row) { return row.known ? row.error.rel_mse_16 : NAN; });
  add("systematic_8", "8 x 8 off", Quantity::kError,
      [](const Outcome&, const Row& row) { return row.systematic.of_8.rms; });
  add("worst_8", "worst 8 x 8", Quantity::kError,
      [](const Outcome&, const Row& row) { return row.systematic.of_8.worst; });
  add("systematic_32", "32 x 32 off", Quantity::kError,
      [](const Outcome&, const Row& row) { return row.systematic.of_32.rms; });
  add("worst_32", "worst 32 x 32", Quantity::kError,
      [](const Outcome&, const Row& row) { return row.systematic.of_32.worst; });
  add("bias", "bias", Quantity::kPercent,
      [](const Outcome&, const Row& row) { return row.known ? row.error.bias : NAN; });

  if (sweep.crowd.known()) {
    report.abstract = sweep.crowd.abstract();
    report.sections.push_back(sweep.crowd.section());
  }
  if (sweep.find("here-full-a")) add_detail(sweep, report);
  if (auto sheet = sheet_of(sweep)) report.sections.push_back({"Wedge", {std::move(*sheet)}});
  if (sweep.find(dolly_id(kDollyPlaces[0] * kDollyStep)))
    report.sections.push_back({"Dolly", {dolly_table(sweep)}});
  return measured;
}

}  // namespace pelage
