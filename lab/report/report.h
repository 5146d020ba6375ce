// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lab/report/label.h"
#include "lab/report/quantity.h"

namespace pelage {

// A report as one value: what an experiment found, without a word on how it is written down. The writers are
// in report_html.h, report_json.h and report_csv.h. Numbers are in SI units and bytes; not-a-number stands
// for "not known".

struct Text {
  std::string text;
};
using Cell = std::variant<double, Text>;

struct Column {
  std::string key;    ///< for machines: "peak_rss_bytes"
  std::string title;  ///< for people: "peak RSS"
  Quantity quantity = Quantity::kRatio;
};

struct Table {
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  ///< as long as `columns`
};

/// The columns of `table` with these keys, in this order; keys it lacks are left out.
Table select(const Table& table, const std::vector<std::string>& keys, std::string caption);

struct Axis {
  std::string label;  ///< without unit
  Quantity quantity = Quantity::kRatio;
  bool log = false;
  double end = 0;  ///< reaches at least this far, so that plots side by side can be compared
};

struct Series {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x ascending; the line breaks where y is not finite
};

/// Lines over x, and areas stacked on each other below them. Areas share their x.
struct LinePlot {
  std::string caption;
  Axis x, y;
  std::vector<Series> areas;
  std::vector<Series> lines;
  bool markers = false;  ///< few points: mark each
  bool half = false;     ///< two beside each other
};

/// Horizontal bars, a group per name. Every series has a value per group.
struct BarPlot {
  struct Values {
    std::string name;
    std::vector<double> values;
  };
  std::string caption;
  Axis value;
  std::vector<std::string> groups;
  std::vector<Values> series;
  bool stacked = false;
  bool half = false;
  std::vector<std::pair<double, double>> spread = {};  ///< least and most per group: a whisker; or empty
  std::vector<std::string> notes = {};                 ///< per group: stands where there is no number
};

/// Pixels for screens: 1 (grey) or 3 (sRGB) bytes each, rows from the top.
struct Picture {
  std::string caption;
  int width = 0, height = 0, channels = 3;
  std::vector<unsigned char> pixels;
  bool half = false;
  std::vector<Label> labels = {};  ///< in pages and SVG files; PNG files go without
};

struct Paragraph {
  std::string text;
};

using Block = std::variant<Paragraph, Table, LinePlot, BarPlot, Picture>;

struct Section {
  std::string heading;
  std::vector<Block> blocks;
};

struct Report {
  std::string experiment;  ///< "bounds"
  std::string title;
  std::string abstract;
  std::vector<std::pair<std::string, std::string>> facts;  ///< what was run, and where
  std::vector<Section> sections;
  Table data;        ///< everything that was measured, a row per variant: what CSV and JSON hold
  std::string runs;  ///< JSON text: each run with its command and its statistics
};

}  // namespace pelage
