// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace pelage {

// Readers for the parameters of commands. They throw Error (kArguments) with one line.

[[noreturn]] void refuse_command(const std::string& message);

/// Checks that a value is an object whose keys are all among `keys`. `name`: of the value, for messages.
void check_object(const nlohmann::json& value, const std::string& name, std::span<const std::string> keys);

/// Reads a text as an object whose keys are all among `keys`.
nlohmann::json read_object(const std::string& text, std::span<const std::string> keys);

/// Returns the numbers of a list of `count` finite numbers from `min` to `max`.
std::vector<double> read_numbers(const nlohmann::json& value, const std::string& name, size_t count,
                                 double min, double max);

/// Returns a number from `min` to `max`.
double read_number(const nlohmann::json& value, const std::string& name, double min, double max);

/// Returns a text that is one of `choices`.
std::string read_choice(const nlohmann::json& object, const std::string& key,
                        std::span<const std::string> choices);

}  // namespace pelage
