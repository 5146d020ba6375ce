// SPDX-License-Identifier: Apache-2.0
#include "lab/report/report_html.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/report/markup.h"
#include "lab/report/picture_svg.h"
#include "lab/report/plot_svg.h"
#include "lab/report/png.h"
#include "lab/report/svg.h"

namespace pelage {
namespace {

constexpr std::string_view kStyle = R"(
body { font: 15px/1.5 "Source Serif 4", Charter, Georgia, serif; color: #111; background: #fff; max-width: 62em;
       margin: 2em auto; padding: 0 1.2em; }
h1 { font-size: 1.6em; line-height: 1.2; margin: 0 0 .4em; }
h2 { font-size: 1.2em; margin: 1.8em 0 .5em; border-bottom: 1px solid #bbb; }
p { margin: .5em 0; max-width: 48em; }
dl { display: grid; grid-template-columns: max-content auto; gap: .1em 1.2em; font-size: .9em; }
dt { color: #555; } dd { margin: 0; overflow-wrap: anywhere; }
table { border-collapse: collapse; font: 12.5px/1.35 "Source Sans 3", "Helvetica Neue", Arial, sans-serif;
        border-top: 1.5px solid #111; border-bottom: 1.5px solid #111; }
th { font-weight: 600; border-bottom: 1px solid #111; vertical-align: bottom; }
th, td { padding: .2em .6em; text-align: right; font-variant-numeric: tabular-nums; }
th.text, td.text { text-align: left; }
tr.even td { background: #f4f4f4; }
.table { margin: 1.2em 0; overflow-x: auto; }
.figures { display: flex; flex-wrap: wrap; gap: .6em 1.2em; margin: 1.2em 0; }
figure { margin: 0; flex: 1 1 100%; } figure.half { flex: 1 1 45%; min-width: 20em; }
figure svg, figure img { display: block; max-width: 100%; height: auto; }
caption, figcaption { font: 13px/1.4 "Source Serif 4", Charter, Georgia, serif; text-align: left; color: #222;
                      padding: .3em 0; max-width: 58em; }
@media print { body { margin: 0; max-width: none; font-size: 10pt; } h2 { break-after: avoid; }
  figure, .table, dl { break-inside: avoid; } .table { overflow: visible; } table { font-size: 7.5pt; }
  body { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
)";

// Only on screens: paper stays white.
constexpr const char* kDarkStyle = R"(
@media screen and (prefers-color-scheme: dark) {
body { color: #e6e6e6; background: #16181c; } h2 { border-color: #555; } dt { color: #a8a8a8; }
table { border-color: #ccc; } th { border-color: #ccc; } tr.even td { background: #202329; }
caption, figcaption { color: #cfcfcf; } a { color: #8fd0f5; }
)";

class Page {
 public:
  explicit Page(const Report& report) {
    out_ +=
        "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
        "<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width\"/>\n";
    out_ += fmt::format(
        "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<h1>{}</h1>\n", escape_markup(report.title),
        std::string(kStyle) + plot_style(Paper::kLight) + kDarkStyle + plot_style(Paper::kDark) + "}\n",
        escape_markup(report.title));
    add(Paragraph{report.abstract});
    out_ += "<dl>\n";
    for (const auto& [name, value] : report.facts)
      out_ += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_markup(name), escape_markup(value));
    out_ += "</dl>\n";
    for (const Section& section : report.sections) add_section(section);
    out_ += "</body>\n</html>\n";
  }
  std::string take() && { return std::move(out_); }

 private:
  void add_section(const Section& section) {
    out_ += fmt::format("<h2>{}</h2>\n", escape_markup(section.heading));
    for (const Block& block : section.blocks) {
      const bool is_figure =
          !std::holds_alternative<Paragraph>(block) && !std::holds_alternative<Table>(block);
      in_figures(is_figure);
      std::visit([&](const auto& content) { add(content); }, block);
    }
    in_figures(false);
  }

  // Consecutive figures share a box, in which half-width ones are side by side.
  void in_figures(bool wanted) {
    if (wanted != in_figures_) out_ += wanted ? "<div class=\"figures\">\n" : "</div>\n";
    in_figures_ = wanted;
  }

  void add(const Paragraph& paragraph) {
    if (!paragraph.text.empty()) out_ += fmt::format("<p>{}</p>\n", escape_markup(paragraph.text));
  }

  void add(const Table& table) {
    out_ += fmt::format("<div class=\"table\"><table>\n<caption><b>Table {}.</b> {}</caption>\n<thead><tr>",
                        ++tables_, escape_markup(table.caption));
    std::vector<DisplayUnit> units;
    std::vector<bool> is_text;
    for (size_t i = 0; i < table.columns.size(); ++i) {
      double largest = 0;
      bool text = false;
      for (const std::vector<Cell>& row : table.rows) {
        if (const double* number = std::get_if<double>(&row[i])) {
          if (std::isfinite(*number)) largest = std::max(largest, std::abs(*number));
        } else {
          text = true;
        }
      }
      units.push_back(display_unit(table.columns[i].quantity, largest));
      is_text.push_back(text);
      out_ += fmt::format(
          "<th{}>{}</th>", text ? " class=\"text\"" : "",
          escape_markup(text ? table.columns[i].title : with_unit(table.columns[i].title, units.back())));
    }
    out_ += "</tr></thead>\n<tbody>\n";
    for (size_t r = 0; r < table.rows.size(); ++r) {
      out_ += r % 2 ? "<tr class=\"even\">" : "<tr>";
      for (size_t i = 0; i < table.rows[r].size(); ++i) {
        const Cell& cell = table.rows[r][i];
        const auto* text = std::get_if<Text>(&cell);
        out_ += fmt::format("<td{}>{}</td>", is_text[i] ? " class=\"text\"" : "",
                            escape_markup(text ? text->text : number_text(std::get<double>(cell), units[i])));
      }
      out_ += "</tr>\n";
    }
    out_ += "</tbody>\n</table></div>\n";
  }

  void add(const LinePlot& plot) { add_figure(line_plot_svg(plot), plot.caption, plot.half); }
  void add(const BarPlot& plot) { add_figure(bar_plot_svg(plot), plot.caption, plot.half); }
  void add(const Picture& picture) {
    const std::string body =
        picture.labels.empty()
            ? fmt::format("<img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\"/>\n",
                          escape_markup(picture.caption), picture.width, picture.height,
                          base64(png_bytes(picture)))
            : picture_svg(picture);
    add_figure(body, picture.caption, picture.half);
  }

  void add_figure(const std::string& body, const std::string& caption, bool half) {
    out_ += fmt::format("<figure{}>\n{}<figcaption><b>Figure {}.</b> {}</figcaption>\n</figure>\n",
                        half ? " class=\"half\"" : "", body, ++figures_, escape_markup(caption));
  }

  std::string out_;
  int tables_ = 0, figures_ = 0;
  bool in_figures_ = false;
};

}  // namespace

std::string report_html(const Report& report) { return Page(report).take(); }

std::vector<std::pair<std::string, std::string>> report_figures(const Report& report) {
  std::vector<std::pair<std::string, std::string>> files;
  int figure = 0;
  for (const Section& section : report.sections) {
    for (const Block& block : section.blocks) {
      const auto* lines = std::get_if<LinePlot>(&block);
      const auto* bars = std::get_if<BarPlot>(&block);
      const auto* picture = std::get_if<Picture>(&block);
      if (!lines && !bars && !picture) continue;
      ++figure;
      if (picture && picture->labels.empty()) continue;  // pixels only
      files.emplace_back(fmt::format("figure-{:02}.svg", figure),
                         standalone_svg(lines  ? line_plot_svg(*lines)
                                        : bars ? bar_plot_svg(*bars)
                                               : picture_svg(*picture)));
    }
  }
  return files;
}

}  // namespace pelage
