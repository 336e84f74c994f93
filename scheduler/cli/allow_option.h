// The option --allow of the verbs that read what a config names.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace seedframe {

inline void add_allow_option(CLI::App& verb, std::vector<std::string>& folders) {
  verb.add_option("--allow", folders,
                  "folder from which the config may take files too (docs/security.md)")
      ->allow_extra_args(false)
      ->check(CLI::ExistingDirectory);
}

}  // namespace seedframe
