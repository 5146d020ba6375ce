// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "base/temporary_folder.h"
#include "image/texture_library.h"
#include "lab/report/png.h"
#include "lab/report/report_csv.h"
#include "lab/report/report_json.h"
#include "lab/report/report_page.h"

namespace pelage {
namespace {

Table odd_table() {
  return {"Odd <things> & \"more\".",
          {{"name", "name"}, {"bytes", "memory", Quantity::kBytes}, {"ratio", "ratio"}},
          {{Text{"plain"}, 3.0 * (1 << 20), 0.1},
           {Text{"a, \"quoted\"\nname"}, double(NAN), double(INFINITY)},
           {Text{"<script>"}, 9.0 * (1 << 20), -1.0 / 3}}};
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

TEST(Png, IsWhatReadersExpect) {
  const std::string png = png_bytes({"", 1, 1, 1, {255}});
  // Checked with an independent decoder (tests/lab/measure_test.py reads larger ones).
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

/// The JSON of a page, as the browser reads it.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script id=\"report\" type=\"application/json\">", end = "</script>";
  const size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find(end, from) - from));
}

TEST(ReportPage, HoldsTheReportAsDataInWhichNoMarkupBegins) {
  Report report;
  report.title = "</script><b>";
  report.facts = {{"Arguments", "--set a='<!--<script>' \xff {{report.js}}"}};
  report.sections = {{"&", {odd_table(), Paragraph{"x < y"}}}};
  const std::string page = report_page(report);
  Report plain;
  plain.facts = {{"", ""}};
  const auto count = [](const std::string& text, const std::string& part) {
    size_t found = 0;
    for (size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  for (const char* markup : {"<script", "</script", "<!--", "<b>"})
    EXPECT_EQ(count(page, markup), count(report_page(plain), markup)) << markup;
  const auto data = data_of(page);
  EXPECT_EQ(data.at("title"), "</script><b>");
  EXPECT_EQ(data.at("facts")[0][1], "--set a='<!--<script>' \uFFFD {{report.js}}");
  const auto& table = data.at("sections")[0].at("blocks")[0];
  EXPECT_EQ(table.at("columns")[1].at("quantity"), "bytes");
  EXPECT_EQ(table.at("rows")[0], nlohmann::json::parse(R"(["plain", 3145728.0, 0.1])"));
  EXPECT_EQ(table.at("rows")[1], nlohmann::json::parse(R"(["a, \"quoted\"\nname", null, {"infinite": 1}])"));
}

TEST(ReportPage, HoldsPlotsAndPictures) {
  Report report;
  LinePlot lines;
  lines.x = {"time", Quantity::kSeconds, true, 9};
  lines.lines = {{"a", {{0, 1}, {1, NAN}}}};
  BarPlot bars;
  bars.groups = {"one"};
  bars.series = {{"s", {-INFINITY}}};
  bars.spread = {{1, 3}};
  Picture picture{"p", 1, 1, 1, {255}};
  picture.labels = {{1, 2, "R & TT", TextAnchor::kMiddle, {255, 0, 16}, 12}};
  report.sections = {{"plots", {lines, bars, picture}}};
  const auto blocks = data_of(report_page(report)).at("sections")[0].at("blocks");
  EXPECT_EQ(blocks[0].at("kind"), "lines");
  EXPECT_EQ(blocks[0].at("x"),
            nlohmann::json::parse(R"({"label": "time", "quantity": "seconds", "log": true, "end": 9.0})"));
  EXPECT_EQ(blocks[0].at("lines")[0].at("points"), nlohmann::json::parse("[[0.0, 1.0], [1.0, null]]"));
  EXPECT_EQ(blocks[1].at("series")[0].at("values"), nlohmann::json::parse(R"([{"infinite": -1}])"));
  EXPECT_EQ(blocks[1].at("spread"), nlohmann::json::parse("[[1.0, 3.0]]"));
  EXPECT_EQ(blocks[2].at("source"), "data:image/png;base64," + base64(png_bytes(picture)));
  EXPECT_EQ(blocks[2].at("labels")[0].at("anchor"), "middle");
  EXPECT_EQ(blocks[2].at("labels")[0].at("color"), nlohmann::json::parse("[255, 0, 16]"));
}

TEST(ReportPage, LoadsNothing) {
  const std::string page = report_page({});
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  for (const char* outside : {"src=\"", "@import", "<link", "fetch(", "url("})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_EQ(page.find("{{"), page.npos) << "a part is missing";
}

}  // namespace
}  // namespace pelage
