// SPDX-License-Identifier: Apache-2.0
#include "lab/report/report_files.h"

#include "base/file.h"
#include "lab/report/report_csv.h"
#include "lab/report/report_json.h"
#include "lab/report/report_page.h"

namespace pelage {

void claim_report_folder(const std::filesystem::path& folder) {
  write_file(folder / "report.json", "{}\n", Links::kReplace);
}

void write_report(const std::filesystem::path& folder, const Report& report) {
  write_file(folder / "report.json", report_json(report), Links::kReplace);
  write_file(folder / "report.csv", csv_text(report.data), Links::kReplace);
  write_file(folder / "report.html", report_page(report), Links::kReplace);
}

}  // namespace pelage
