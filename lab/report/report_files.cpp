// SPDX-License-Identifier: Apache-2.0
#include "lab/report/report_files.h"

#include <vector>

#include "base/file.h"
#include "lab/report/report_csv.h"
#include "lab/report/report_html.h"
#include "lab/report/report_json.h"

namespace pelage {

void claim_report_folder(const std::filesystem::path& folder) { write_file(folder / "report.json", "{}\n"); }

void write_report(const std::filesystem::path& folder, const Report& report) {
  write_file(folder / "report.json", report_json(report));
  write_file(folder / "report.csv", csv_text(report.data));
  write_file(folder / "report.html", report_html(report));
}

void write_report_figures(const std::filesystem::path& folder, const Report& report) {
  const std::filesystem::path figures = folder / "figures";
  std::vector<std::filesystem::path> old;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(figures, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("figure-") && name.ends_with(".svg")) old.push_back(entry.path());
  }
  for (const auto& path : old) std::filesystem::remove(path, ignored);
  for (const auto& [name, svg] : report_figures(report)) write_file(figures / name, svg);
}

}  // namespace pelage
