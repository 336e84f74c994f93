// What is made of a command line's description: completions for three shells, and the man page.
// All are pure texts; the program prints them itself (cli/manual.cpp), so they cannot lag behind.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "manual/command.h"

namespace seedframe {

/// Scripts to be sourced, or put where the shell looks for completions.
std::string bash_completion(const CommandText& program);
std::string zsh_completion(const CommandText& program);
std::string fish_completion(const CommandText& program);

/// What a man page says beside the verbs: pairs of a term and its meaning.
struct ManualNotes {
  using Terms = std::vector<std::pair<std::string, std::string>>;
  std::string version;
  Terms exit_codes;
  Terms environment;
  Terms files;
};
/// In roff, with the macros of man(7); without a date, so that equal programs have equal pages.
std::string man_page(const CommandText& program, const ManualNotes& notes);

}  // namespace seedframe
