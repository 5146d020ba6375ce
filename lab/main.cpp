// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "cli/program.h"
#include "lab/lab_options.h"

int main(int argc, char** argv) {
  return pelage::run_program(argc, argv, [](const std::vector<std::string>& arguments) {
    const auto options = pelage::parse_lab_options(arguments, std::cout);
    if (!options) return 0;
    return options->task == pelage::LabTask::kMeasure ? run_measure(*options) : run_compare(*options);
  });
}
