// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/error.h"
#include "base/temporary_folder.h"
#include "lab/measure/experiments.h"
#include "lab/runs/outcome_table.h"
#include "lab/runs/spread.h"

namespace pelage {
namespace {

constexpr double kShares[] = {1, 0.5, 0.25, 0.1, 0.05};
constexpr const char* kInCore = "fur-64";  // the baseline for paging
constexpr const char* kYardstick = "embree-compact";

constexpr const char* kMethod =
    "The fur of the frame, without skins, is grown once. The same rays then go through it in every variant, "
    "each in its own process, on {}. Camera rays start at points of the picture, tile by tile. Gather rays "
    "start where camera rays meet fur and go in all directions; sorted rays are the same rays, ordered by "
    "octant of direction and along a space-filling curve. Shadow rays go from there to lights. Deep rays "
    "start at places spread evenly over all strands and ask only whether anything blocks them. A ray that "
    "starts on a strand ignores that strand near its start; Embree has no such rule for one strand, so there "
    "the ray starts two widths away. Each kind is traced once untimed; then the faster of two passes counts, "
    "or one pass if the fur is paged. Every variant runs {}, in rounds; the run of median time counts.";

constexpr const char* kPaging =
    "Paged fur is the quantised tree cut into pages of 128 KiB, in a file. A page is read when a ray needs "
    "it, by explicit reads that bypass the system's cache, and is dropped when memory runs short. The budget "
    "is p % of the size of the tree. It covers everything: the table, the tree over the boxes of pages, "
    "waiting rays and the pages themselves; 100 % holds all pages as well. Alone: a ray waits for each page. "
    "Together: up to 16,384 rays, limited to a quarter of the budget at 64 bytes per ray, wait in the queues "
    "of the pages that they need next; a page is read once for all its rays, while others traverse the "
    "previous page.";

struct Kind {
  const char *id, *title;
};
constexpr Kind kKinds[] = {{"camera", "camera"},
                           {"gather", "gather"},
                           {"sorted", "gather, sorted"},
                           {"shadow", "shadow"},
                           {"deep", "deep occlusion"}};

Variant variant_of(const std::string& id, const std::string& title, const std::string& name,
                   const std::filesystem::path& work) {
  return {id, title, "trace", {"--variant", name, "-o", work.string()}};
}

std::vector<Variant> variants(const std::filesystem::path& work) {
  std::vector<Variant> all{variant_of("embree-fast", "Embree fast", "embree-fast", work),
                           variant_of(kYardstick, "Embree compact", kYardstick, work),
                           variant_of("fur-128", "fur 128", "fur-128", work),
                           variant_of(kInCore, "fur 64", kInCore, work)};
  for (const double share : kShares) {
    Variant paged = variant_of(fmt::format("paged-{:g}", 100 * share),
                               fmt::format("paged, {:g} %", 100 * share), "paged", work);
    paged.arguments.insert(paged.arguments.end(), {"--share", fmt::format("{:g}", share)});
    all.push_back(std::move(paged));
  }
  return all;
}

double of_kind(const Outcome& o, const std::string& kind, const char* what) {
  return o.number("kinds." + kind + "." + what);
}
double rays_per_s(const Outcome& o, const std::string& kind) {
  return of_kind(o, kind, "rays") / of_kind(o, kind, "wall_s");
}
double per_ray(const Outcome& o, const std::string& kind, const char* what) {
  const double count = of_kind(o, kind, what);
  return count > 0 ? count / of_kind(o, kind, "rays") : NAN;
}

const Outcome* find(const std::vector<Outcome>& outcomes, const std::string& id) {
  for (const Outcome& o : outcomes) {
    if (o.variant.id == id) return &o;
  }
  return nullptr;
}

/// Factor by which CPU time for a kind of rays is smaller than the yardstick's.
RatioSpread cpu_speed(const Outcome& yardstick, const Outcome& o, const std::string& kind) {
  return ratio_of(yardstick, o, "kinds." + kind + ".cpu_s");
}

Table table_of(const std::vector<Outcome>& outcomes, double segments) {
  Table table;
  table.rows.resize(outcomes.size());
  const auto add = [&](const std::string& key, const std::string& title, Quantity quantity,
                       const std::function<Cell(const Outcome&)>& value) {
    add_column(table, {key, title, quantity}, outcomes, value);
  };
  add("variant", "variant", Quantity::kRatio, [](const Outcome& o) -> Cell { return Text{o.variant.title}; });
  add("status", "status", Quantity::kRatio, [](const Outcome& o) -> Cell { return Text{o.status()}; });
  add("bytes", "size", Quantity::kBytes, [](const Outcome& o) -> Cell { return o.number("bytes"); });
  add("bytes_per_segment", "bytes per segment", Quantity::kRatio,
      [=](const Outcome& o) -> Cell { return o.number("bytes") / segments; });
  add("limit_bytes", "budget", Quantity::kBytes, [](const Outcome& o) -> Cell {
    const double limit = o.number("limit_bytes");
    return limit > 0 ? limit : NAN;
  });
  add("resident_bytes", "resident", Quantity::kBytes,
      [](const Outcome& o) -> Cell { return o.number("resident_bytes"); });
  add("peak_rss_bytes", "peak RSS", Quantity::kBytes,
      [](const Outcome& o) -> Cell { return o.number("peak_rss_bytes"); });
  add("build_cpu_s", "build (CPU)", Quantity::kSeconds,
      [](const Outcome& o) -> Cell { return o.number("build_cpu_s"); });
  const Outcome* in_core = find(outcomes, kInCore);
  const Outcome* yardstick = find(outcomes, kYardstick);
  for (const Kind& kind : kKinds) {
    const std::string id = kind.id, title = kind.title;
    add("rays_" + id, title, Quantity::kRate, [=](const Outcome& o) -> Cell { return rays_per_s(o, id); });
    add("together_" + id, title + ", together", Quantity::kRate,
        [=](const Outcome& o) -> Cell { return rays_per_s(o, id + "_together"); });
    add("over_embree_" + id, title, Quantity::kRatio, [=](const Outcome& o) -> Cell {
      return yardstick ? rays_per_s(o, id) / rays_per_s(*yardstick, id) : NAN;
    });
    add("cpu_over_embree_" + id, title, Quantity::kRatio, [=](const Outcome& o) -> Cell {
      return yardstick ? of_kind(*yardstick, id, "cpu_s") / of_kind(o, id, "cpu_s") : NAN;
    });
    add("over_core_" + id, title, Quantity::kPercent, [=](const Outcome& o) -> Cell {
      return in_core ? rays_per_s(o, id) / rays_per_s(*in_core, id) : NAN;
    });
    add("together_over_core_" + id, title + ", together", Quantity::kPercent, [=](const Outcome& o) -> Cell {
      return in_core ? rays_per_s(o, id + "_together") / rays_per_s(*in_core, id) : NAN;
    });
    add("cpu_s_" + id, title, Quantity::kSeconds,
        [=](const Outcome& o) -> Cell { return of_kind(o, id, "cpu_s"); });
    add("cpu_rays_" + id, title, Quantity::kRate,
        [=](const Outcome& o) -> Cell { return of_kind(o, id, "rays") / of_kind(o, id, "cpu_s"); });
    add("cpu_spread_" + id, title, Quantity::kRatio, [=](const Outcome& o) -> Cell {
      return yardstick ? Text{spread_text(cpu_speed(*yardstick, o, id))} : Text{"–"};
    });
    add("hits_" + id, title, Quantity::kPercent,
        [=](const Outcome& o) -> Cell { return of_kind(o, id, "hits") / of_kind(o, id, "rays"); });
    add("boxes_" + id, title + ", boxes", Quantity::kRatio,
        [=](const Outcome& o) -> Cell { return per_ray(o, id, "box_tests"); });
    add("segments_" + id, title + ", segments", Quantity::kRatio,
        [=](const Outcome& o) -> Cell { return per_ray(o, id, "segment_tests"); });
    add("faults_" + id, title, Quantity::kCount,
        [=](const Outcome& o) -> Cell { return of_kind(o, id, "page_faults"); });
    add("faults_together_" + id, title + ", together", Quantity::kCount,
        [=](const Outcome& o) -> Cell { return of_kind(o, id + "_together", "page_faults"); });
    add("answers_" + id, title, Quantity::kRatio, [=](const Outcome& o) -> Cell {
      const double own = of_kind(o, id, "answers");
      if (!in_core || !(own > 0)) return Text{"–"};
      const double together = of_kind(o, id + "_together", "answers"),
                   expected = of_kind(*in_core, id, "answers");
      const bool same = own == expected && (!(together > 0) || together == expected);
      return Text{same ? "identical" : "different"};
    });
  }
  return table;
}

std::vector<std::string> keys(std::vector<std::string> first, const std::string& prefix) {
  for (const Kind& kind : kKinds) first.push_back(prefix + kind.id);
  return first;
}

/// Rows of variants whose ids start with `prefix`.
Table rows_of(Table table, const std::vector<Outcome>& outcomes, const std::string& prefix) {
  std::vector<std::vector<Cell>> rows;
  for (size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].variant.id.starts_with(prefix)) rows.push_back(table.rows[i]);
  }
  table.rows = std::move(rows);
  return table;
}

// CPU time, because other work on the machine affects wall time more.
std::string abstract_of(const std::vector<Outcome>& outcomes, double segments) {
  const Outcome *fur = find(outcomes, kInCore), *embree = find(outcomes, kYardstick);
  if (!fur || !embree || !fur->succeeded() || !embree->succeeded()) return "";
  std::string text = fmt::format(
      "{:.0f} segments. The quantised fur tree takes {:.1f} bytes per segment, Embree compact {:.1f}. In CPU "
      "time the fur tree traces camera rays {} times, gather rays {} times and deep occlusion rays {} times "
      "as fast as Embree compact{}.",
      segments, fur->number("bytes") / segments, embree->number("bytes") / segments,
      spread_text(cpu_speed(*embree, *fur, "camera")), spread_text(cpu_speed(*embree, *fur, "gather")),
      spread_text(cpu_speed(*embree, *fur, "deep")),
      fur->runs.size() > 1 ? "; brackets give the minimum and maximum over any two runs" : "");
  if (const Outcome* paged = find(outcomes, "paged-25"); paged && paged->succeeded()) {
    const bool together = of_kind(*paged, "sorted_together", "cpu_s") < of_kind(*paged, "sorted", "cpu_s");
    const RatioSpread camera = ratio_of(*paged, *fur, "kinds.camera.cpu_s");
    const double sorted =
        of_kind(*paged, together ? "sorted_together" : "sorted", "cpu_s") / of_kind(*fur, "sorted", "cpu_s");
    text += fmt::format(
        " With memory for a quarter of its size, camera rays take {} times and sorted gather rays {:.2f} "
        "times the CPU time that they take with all of it in memory.",
        spread_text(camera), sorted);
  }
  return text;
}

}  // namespace

Measured measure_accel(const SceneDescription& scene, const MeasureSetup& given, Progress& progress) {
  MeasureSetup setup = given;
  // Times per thread are compared.
  bool threads_given = false;
  for (const std::string& argument : setup.arguments) threads_given |= argument == "--threads";
  if (!threads_given) setup.arguments.insert(setup.arguments.end(), {"--threads", "1"});
  if (scene.grooms.items.empty()) throw Error(ErrorKind::kInput, "measure accel: the scene has no fur");
  const TemporaryFolder folder(setup.folder);
  const std::filesystem::path& work = folder.path();

  VariantRunner runner(setup, progress, 1 + variants(work).size());
  Variant prepare = variant_of("prepare", "prepare", "prepare", work);
  prepare.once = true;
  Measured measured;
  measured.outcomes.push_back(runner.run(prepare));
  const double segments = measured.outcomes[0].number("segments");
  std::vector<Outcome> outcomes;
  if (measured.outcomes[0].succeeded() && !progress.cancelled())
    outcomes = runner.run_in_rounds(variants(work));

  Report& report = measured.report;
  report.title = "Structures traced";
  report.abstract = abstract_of(outcomes, segments);
  report.data = table_of(outcomes, segments);
  const Table& data = report.data;
  const int threads = std::stoi(setup.arguments.back());
  report.sections.push_back(
      {"Method",
       {Paragraph{fmt::format(kMethod, counted(threads, "thread"), counted(setup.repeat, "time"))}}});
  const std::vector<Outcome> whole(outcomes.begin(),
                                   outcomes.begin() + std::min<std::ptrdiff_t>(4, std::ssize(outcomes)));
  const auto in_core = [&](const Table& t) {
    Table result = t;
    result.rows.resize(std::min<size_t>(4, result.rows.size()));
    return result;
  };
  report.sections.push_back(
      {"In memory",
       {in_core(select(data, keys({"variant", "bytes", "bytes_per_segment", "build_cpu_s"}, "cpu_rays_"),
                       "Size, CPU time to build, and rays per CPU second.")),
        column_plot(in_core(data), whole, {"cpu_rays_camera", "cpu_rays_gather", "cpu_rays_deep"},
                    "rays per CPU second", "Rays per CPU second."),
        in_core(select(data, keys({"variant"}, "cpu_spread_"),
                       "Speed relative to Embree compact by CPU time: for the median runs and, in brackets, "
                       "the minimum and maximum over any two runs.")),
        in_core(select(data, keys({"variant"}, "over_embree_"),
                       "The same by wall time, which other work on the machine distorts.")),
        in_core(select(data, keys(keys({"variant"}, "boxes_"), "segments_"),
                       "Tests of boxes and of segments per ray; Embree does not count them.")),
        in_core(select(data, keys({"variant"}, "hits_"), "Rays that hit something."))}});
  const auto paged = [&](const std::vector<std::string>& columns, const char* caption) {
    return rows_of(select(data, columns, caption), outcomes, "paged");
  };
  report.sections.push_back(
      {"Larger than memory",
       {Paragraph{kPaging},
        paged({"variant", "status", "bytes", "limit_bytes", "resident_bytes", "peak_rss_bytes"},
              "Budgets, and the maximum resident memory: by the ledger, and of the whole process."),
        paged(keys(keys({"variant"}, "over_core_"), "together_over_core_"),
              "Speed relative to the same tree in memory."),
        paged(keys(keys({"variant"}, "faults_"), "faults_together_"), "Pages read in one pass."),
        paged(keys({"variant"}, "answers_"), "Hits compared bit by bit with those of the tree in memory.")}});
  for (Outcome& outcome : outcomes) measured.outcomes.push_back(std::move(outcome));
  return measured;
}

}  // namespace pelage
