// The option --allow of the verbs that read what a config names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/home.h"

namespace seedframe {

inline void add_allow_option(CLI::App& verb, std::vector<std::string>& folders) {
  verb.add_option("--allow", folders,
                  "folder from which the config may take files too (docs/security.md)")
      ->allow_extra_args(false)
      ->check(CLI::ExistingDirectory);
}

/// With the user's own asset library, which configs may always read.
inline std::vector<std::string> with_own_assets(std::vector<std::string> folders) {
  std::error_code error;
  if (std::filesystem::is_directory(own_assets(), error)) folders.push_back(own_assets().string());
  return folders;
}

}  // namespace seedframe
