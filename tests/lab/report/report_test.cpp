// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "base/temporary_folder.h"
#include "image/texture_library.h"
#include "lab/report/axis_ticks.h"
#include "lab/report/markup.h"
#include "lab/report/plot_svg.h"
#include "lab/report/png.h"
#include "lab/report/report_csv.h"
#include "lab/report/report_html.h"
#include "lab/report/report_json.h"
#include "lab/report/svg.h"

namespace pelage {
namespace {

Table odd_table() {
  return {"Odd <things> & \"more\".",
          {{"name", "name"}, {"bytes", "memory", Quantity::kBytes}, {"ratio", "ratio"}},
          {{Text{"plain"}, 3.0 * (1 << 20), 0.1},
           {Text{"a, \"quoted\"\nname"}, double(NAN), double(INFINITY)},
           {Text{"<script>"}, 9.0 * (1 << 20), -1.0 / 3}}};
}

TEST(Quantity, ChoosesUnitsThatReadWell) {
  EXPECT_EQ(number_text(12345678, display_unit(Quantity::kCount, 12345678)), "12\u202f345\u202f678");
  EXPECT_EQ(number_text(-1234, display_unit(Quantity::kCount, 1234)), "−1234");
  EXPECT_EQ(display_unit(Quantity::kBytes, 3.0 * (1 << 20)).symbol, "MiB");
  EXPECT_EQ(number_text(3.0 * (1 << 20), display_unit(Quantity::kBytes, 3.0 * (1 << 20))), "3.000");
  EXPECT_EQ(number_text(0.05, display_unit(Quantity::kSeconds, 0.05)), "50.00");
  EXPECT_EQ(number_text(0.25, display_unit(Quantity::kPercent, 1)), "25.0");
  EXPECT_EQ(number_text(0.0022, display_unit(Quantity::kError, 0.64)), "0.220");
  EXPECT_EQ(number_text(NAN, {}), "–");
  EXPECT_EQ(number_text(-INFINITY, {}), "−∞");
  EXPECT_EQ(number_text(-0.001, {1, "", 1}), "0.0");
}

TEST(AxisTicks, AreRoundAndWithin) {
  EXPECT_EQ(linear_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(log_ticks(3, 100), (std::vector<double>{5, 10, 20, 50, 100}));
  EXPECT_EQ(log_ticks(1, 1e6).size(), 7u);
  EXPECT_TRUE(linear_ticks(1, 1, 5).empty());
  EXPECT_TRUE(linear_ticks(0, INFINITY, 5).empty());
  EXPECT_TRUE(log_ticks(0, 5).empty());
  EXPECT_EQ(tick_labels({0, 0.5, 1}, false), (std::vector<std::string>{"0.0", "0.5", "1.0"}));
  EXPECT_EQ(tick_labels({0.5, 1, 20}, true), (std::vector<std::string>{"0.5", "1", "20"}));
}

TEST(Markup, IsEscapedAndWellFormed) {
  EXPECT_EQ(escape_markup("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
  EXPECT_EQ(escape_markup("Pelz – ×"), "Pelz – ×");
  EXPECT_EQ(escape_markup(std::string_view("\x01\0x", 3)), "\uFFFD\uFFFDx");
  EXPECT_EQ(escape_markup("\xff\xc3"), "\uFFFD\uFFFD");
  EXPECT_EQ(escape_markup("\xed\xa0\x80"), "\uFFFD\uFFFD\uFFFD");  // a surrogate
}

TEST(ReportCsv, ReadsBackTheSame) {
  const std::string csv = csv_text(odd_table());
  EXPECT_EQ(csv,
            "name,bytes,ratio\r\nplain,3145728,0.1\r\n\"a, \"\"quoted\"\"\nname\",,inf\r\n"
            "<script>,9437184,-0.3333333333333333\r\n");
  EXPECT_EQ(std::stod("-0.3333333333333333"), -1.0 / 3);
}

TEST(ReportJson, HoldsNumbersAndNullsForWhatIsNone) {
  Report report;
  report.experiment = "bounds";
  report.facts = {{"Scene", "\xff.yaml"}};
  report.data = odd_table();
  report.runs = R"([{"exit_code": 4}])";
  const auto json = nlohmann::json::parse(report_json(report));
  EXPECT_EQ(json.at("schema"), kReportSchema);
  EXPECT_EQ(json.at("rows")[0].at("bytes"), 3 << 20);
  EXPECT_TRUE(json.at("rows")[1].at("bytes").is_null());
  EXPECT_TRUE(json.at("rows")[1].at("ratio").is_null());
  EXPECT_EQ(json.at("rows")[2].at("ratio"), -1.0 / 3);
  EXPECT_EQ(json.at("columns")[1].at("unit"), "bytes");
  EXPECT_EQ(json.at("runs")[0].at("exit_code"), 4);
}

TEST(PlotSvg, LeavesGapsWhereNumbersAreMissing) {
  LinePlot plot;
  plot.lines = {{"a", {{0, 1}, {1, 2}, {2, NAN}, {3, 4}, {4, 5}, {5, INFINITY}}}};
  const std::string svg = line_plot_svg(plot);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  size_t lines = 0;
  for (size_t at = 0; (at = svg.find("<polyline", at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 3u);  // two pieces, and the legend's
}

TEST(PlotSvg, HasNoNumberThatIsNoneEvenWithoutData) {
  LinePlot lines;
  lines.x.log = lines.y.log = true;
  BarPlot bars;
  bars.groups = {"a", "b"};
  bars.series = {{"s", {NAN}}, {"t", {INFINITY, -3}}};
  BarPlot stacked = bars;
  stacked.stacked = true;
  LinePlot areas;
  areas.areas = {{"empty", {}}, {"longer", {{0, 1}}}};
  for (const std::string& svg : {line_plot_svg(lines), bar_plot_svg(bars), bar_plot_svg(stacked),
                                 bar_plot_svg({}), line_plot_svg(areas)}) {
    EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
    EXPECT_EQ(svg.find("inf"), std::string::npos) << svg;
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
  }
}

TEST(PlotSvg, ShowsTheSpreadAndNotesWhereThereIsNoNumber) {
  BarPlot bars;
  bars.groups = {"a", "b"};
  bars.series = {{"s", {2, NAN}}};
  const auto marks = [](const std::string& svg) {
    size_t count = 0;
    for (size_t at = 0; (at = svg.find("class=\"axis\"", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  const size_t plain = marks(bar_plot_svg(bars));
  bars.spread = {{1, 3}, {NAN, NAN}};
  bars.notes = {"", "refused"};
  const std::string svg = bar_plot_svg(bars);
  EXPECT_EQ(marks(svg), plain + 3);
  EXPECT_NE(svg.find(">refused<"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(PlotSvg, StandsAloneWithItsColors) {
  LinePlot plot;
  plot.lines = {{"a", {{0, 1}, {1, 2}}}};
  const std::string svg = line_plot_svg(plot), file = standalone_svg(svg);
  EXPECT_EQ(svg.find("<style>"), std::string::npos);
  EXPECT_NE(file.find(".line.s0 { stroke: #0072b2; }"), std::string::npos);
  EXPECT_NE(plot_style(Paper::kLight), plot_style(Paper::kDark));
}

TEST(Png, IsWhatReadersExpect) {
  const std::string png = png_bytes({"", 1, 1, 1, {255}});
  // Checked with an independent decoder (tests/cli/measure_test.py reads larger ones).
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
}

/// An independent reader gets the pixels back, whatever filter their rows are best served by.
TEST(Png, IsReadBackAndSmaller) {
  Picture picture{"", 61, 50, 3, {}};
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const int noise = static_cast<int>(mix64(static_cast<uint64_t>(61 * y + x)) & 255);
      const int values[] = {4 * x, y < 10 ? 200 : y < 20 ? noise : 3 * y + 2 * x, x ^ y};
      for (int value : values) picture.pixels.push_back(static_cast<unsigned char>(value));
    }
  }
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.png";
  std::ofstream(file, std::ios::binary) << png_bytes(picture);
  EXPECT_LT(std::filesystem::file_size(file), picture.pixels.size() / 3);
  MemoryLedger ledger;
  TextureLibrary library(ledger);
  const auto texture = library.load(AssetPath{file, {}}, ColorSpace::kLinear);
  ASSERT_EQ(texture->width(), picture.width);
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    const auto pixel = static_cast<int>(i / 3);
    const Rgb texel = texture->texel(pixel % picture.width, pixel / picture.width);
    ASSERT_NEAR(texel[static_cast<int>(i % 3)] * 255, picture.pixels[i], 1e-3) << i;
  }
}

TEST(Base64, IsPadded) {
  EXPECT_EQ(base64("Man"), "TWFu");
  EXPECT_EQ(base64("Ma"), "TWE=");
  EXPECT_EQ(base64("M"), "TQ==");
  EXPECT_EQ(base64(""), "");
}

TEST(ReportHtml, EscapesEverything) {
  Report report;
  report.title = "<b>";
  report.facts = {{"Arguments", "--set a='<i>'"}};
  report.sections = {{"&", {odd_table(), Paragraph{"x < y"}}}};
  const std::string html = report_html(report);
  for (const char* raw : {"<b></title>", "<i>", "<script>", "x < y"})
    EXPECT_EQ(html.find(raw), std::string::npos) << raw;
  EXPECT_NE(html.find("memory (MiB)"), std::string::npos) << html;
}

}  // namespace
}  // namespace pelage
