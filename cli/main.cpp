// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>

#include "base/program.h"
#include "cli/commands.h"
#include "cli/lab_program.h"
#include "cli/program.h"

namespace {

int run(const pelage::Options& options) {
  using pelage::Command;
  switch (options.command) {
    case Command::kNew:
      return pelage::run_new(options);
    case Command::kRender:
      return pelage::run_render(options);
    case Command::kGrow:
      return pelage::run_grow(options);
    case Command::kSimulate:
      return pelage::run_simulate(options);
    case Command::kInfo:
      return pelage::run_info(options);
    case Command::kFarm:
      return pelage::run_farm(options);
    case Command::kMerge:
      return pelage::run_merge(options);
    case Command::kConvert:
      return pelage::run_convert(options);
    case Command::kMotionBlur:
      return pelage::run_motion_blur(options);
    case Command::kStereo:
      return pelage::run_stereo(options);
    case Command::kValidate:
      return pelage::run_validate(options);
    case Command::kRib:
      return pelage::run_rib(options);
    case Command::kExport:
      return pelage::run_export(options);
    case Command::kProcedural:
      return pelage::run_procedural(options);
    case Command::kView:
      return pelage::run_view(options);
    case Command::kWhy:
      return pelage::run_why(options);
    case Command::kManual:
      return pelage::run_manual(options);
  }
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  return pelage::run_program(argc, argv, [](const std::vector<std::string>& arguments) {
    if (pelage::is_lab_command(arguments)) {
      const std::filesystem::path lab = pelage::current_program().parent_path() / "pelage-lab";
      return pelage::start_lab(lab, arguments, std::cout);
    }
    const auto options = pelage::parse_options(arguments, std::cout);
    return options ? run(*options) : 0;
  });
}
