// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "exchange/scene_export.h"
#include "geom/alembic/alembic_curves_writer.h"

namespace CLI {
class App;
}

namespace pelage {

/// Adds the flags of `export`, except those that all commands with a scene have. `format`: the text of its
/// format, for interpret_export().
void add_export_flags(CLI::App& command, std::string& folder, std::string& format);

/// Returns the format that a text names. Throws Error (kArguments) with the nearest name.
ExportFormat interpret_export(const std::string& format);

/// Adds --for, a flag of `convert`, and interprets its text. interpret_host() throws Error (kArguments) for
/// unknown programs.
void add_host_flag(CLI::App& command, std::string& host);
AlembicHost interpret_host(const std::string& host);

}  // namespace pelage
