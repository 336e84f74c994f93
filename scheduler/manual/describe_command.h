// From CLI11's description of the program to what the manual says of it.
#pragma once

#include <string>
#include <vector>

#include "manual/command.h"

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace seedframe {

/// Everything that --help knows. An option's words are those of CLI::IsMember, or of `offers`.
CommandText describe_command(CLI::App& app);

/// For Option::check: the words that shells offer for its value. It refuses nothing, and --help
/// does not show it: for options whose own check says more than "not one of them".
CLI::Validator offers(const std::vector<std::string>& words);

}  // namespace seedframe
