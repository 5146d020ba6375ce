// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pelage {

// A report as data, independent of its file format. report_page.h, report_json.h and report_csv.h write it.
// Numbers are in SI units and bytes. NaN means "unknown".

/// The quantity that a number measures. It determines the unit and the format in which readers see the
/// number.
enum class Quantity {
  kCount,    ///< an integer without unit
  kSeconds,  ///< seconds, shown in s or ms
  kBytes,    ///< bytes, shown in B, KiB, MiB or GiB
  kRate,     ///< number per second
  kRatio,    ///< a ratio without unit
  kPercent,  ///< a fraction, shown as a percentage with one decimal
  kError,    ///< a fraction, shown as a percentage with three decimals
};
/// Returns the name in data files: "count", "seconds" and so on.
const char* quantity_name(Quantity quantity);

struct Text {
  std::string text;
};
using Cell = std::variant<double, Text>;

struct Column {
  std::string key;    ///< name for programs: "peak_rss_bytes"
  std::string title;  ///< name for readers: "peak RSS"
  Quantity quantity = Quantity::kRatio;
};

struct Table {
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  ///< each row has one cell per column
};

/// Returns the columns of `table` with the given keys, in the order of `keys`. Keys that the table does not
/// have are skipped.
Table select(const Table& table, const std::vector<std::string>& keys, std::string caption);

struct Axis {
  std::string label;  ///< without unit
  Quantity quantity = Quantity::kRatio;
  bool log = false;
  double end = 0;  ///< min upper end of the axis, so that plots side by side can have the same axis; 0: none
};

struct Series {
  std::string name;
  /// Points (x, y) with ascending x. The line is interrupted where y is not finite.
  std::vector<std::pair<double, double>> points;
};

/// Lines over x, drawn on top of stacked areas. All areas have the same x values.
struct LinePlot {
  std::string caption;
  Axis x, y;
  std::vector<Series> areas;
  std::vector<Series> lines;
  bool markers = false;  ///< whether to draw a marker at each point, for lines of few points
  bool half = false;     ///< whether to use half the page width, so that two plots fit side by side
};

/// Horizontal bars in groups. Every series has one value per group.
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
  std::vector<std::pair<double, double>> spread = {};  ///< min and max per group, drawn as whiskers; or empty
  std::vector<std::string> notes = {};  ///< per group: text shown where a value is not finite; or empty
};

enum class TextAnchor { kStart, kMiddle, kEnd };

/// Text on top of a picture. Lengths are in pixels; y points down.
struct Label {
  double x = 0, y = 0;  ///< position of the anchor, on the baseline
  std::string text;
  TextAnchor anchor = TextAnchor::kStart;
  std::array<unsigned char, 3> color = {0, 0, 0};  ///< sRGB
  double size = 14;                                ///< size of the font
};

/// Pixels for screens: 1 byte (grey) or 3 bytes (sRGB) each, in rows from the top.
struct Picture {
  std::string caption;
  int width = 0, height = 0, channels = 3;
  std::vector<unsigned char> pixels;
  bool half = false;
  std::vector<Label> labels = {};  ///< shown in web pages; PNG files omit them
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
  std::string experiment;  ///< name of the experiment: "bounds"
  std::string title;
  std::string abstract;
  /// Name and value of facts about the scene, the settings and the machine.
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<Section> sections;
  Table data;        ///< all measurements, one row per variant: written to CSV and JSON
  std::string runs;  ///< all runs, each with its command and its statistics, as JSON text
};

}  // namespace pelage
