// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lab/report/label.h"
#include "lab/report/quantity.h"

namespace pelage {

// A report as one value, independent of how it is written. The writers are in report_html.h, report_json.h
// and report_csv.h. Numbers are in SI units and bytes; NaN means "unknown".

struct Text {
  std::string text;
};
using Cell = std::variant<double, Text>;

struct Column {
  std::string key;    ///< for programs: "peak_rss_bytes"
  std::string title;  ///< for readers: "peak RSS"
  Quantity quantity = Quantity::kRatio;
};

struct Table {
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  ///< as long as `columns`
};

/// The columns of `table` with these keys, in this order; missing keys are skipped.
Table select(const Table& table, const std::vector<std::string>& keys, std::string caption);

struct Axis {
  std::string label;  ///< without unit
  Quantity quantity = Quantity::kRatio;
  bool log = false;
  double end = 0;  ///< the axis reaches at least this far, so that plots side by side can be compared
};

struct Series {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x ascending; the line breaks where y is not finite
};

/// Lines over x, drawn on top of stacked areas. Areas share their x.
struct LinePlot {
  std::string caption;
  Axis x, y;
  std::vector<Series> areas;
  std::vector<Series> lines;
  bool markers = false;  ///< few points: draw a marker at each
  bool half = false;     ///< half the page width, two side by side
};

/// Horizontal bars, one group per name. Every series has one value per group.
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
  std::vector<std::pair<double, double>> spread = {};  ///< min and max per group (whiskers); or empty
  std::vector<std::string> notes = {};                 ///< per group: shown where there is no number
};

/// Pixels for screens: 1 (grey) or 3 (sRGB) bytes each, rows from the top.
struct Picture {
  std::string caption;
  int width = 0, height = 0, channels = 3;
  std::vector<unsigned char> pixels;
  bool half = false;
  std::vector<Label> labels = {};  ///< in pages and SVG files; PNG files omit them
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
  Table data;        ///< all measurements, one row per variant: the content of CSV and JSON
  std::string runs;  ///< JSON text: each run with its command and its statistics
};

}  // namespace pelage
