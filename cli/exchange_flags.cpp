// SPDX-License-Identifier: Apache-2.0
#include "cli/exchange_flags.h"

#include <algorithm>
#include <iterator>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/error.h"
#include "base/nearest_name.h"

namespace pelage {

void add_export_flags(CLI::App& command, std::string& folder, std::string& format) {
  command.add_option("-o,--output", folder, "Folder to write; it may exist")->required()->type_name("DIR");
  command
      .add_option("--format", format,
                  "Format: usd, pbrt (version 4), mitsuba (version 3) or alembic (strands only)")
      ->required()
      ->type_name("FORMAT");
}

ExportFormat interpret_export(const std::string& format) {
  if (format.empty()) return ExportFormat::kUsd;
  const std::vector<std::string> names(std::begin(EnumNames<ExportFormat>::names),
                                       std::end(EnumNames<ExportFormat>::names));
  const auto found = std::find(names.begin(), names.end(), format);
  if (found == names.end()) {
    throw Error(ErrorKind::kArguments,
                "--format " + quote(format) + " is not known" + suggest(format, names));
  }
  return static_cast<ExportFormat>(found - names.begin());
}

void add_host_flag(CLI::App& command, std::string& host) {
  command
      .add_option("--for", host,
                  "Program that an .abc file is made for: unreal, with z up, left-handed axes and straight "
                  "segments; lengths must be in centimetres")
      ->type_name("PROGRAM");
}

AlembicHost interpret_host(const std::string& host) {
  if (host.empty()) return AlembicHost::kAny;
  if (host == "unreal") return AlembicHost::kUnreal;
  const std::vector<std::string> names{"unreal"};
  throw Error(ErrorKind::kArguments, "--for " + quote(host) + " is not known" + suggest(host, names));
}

}  // namespace pelage
