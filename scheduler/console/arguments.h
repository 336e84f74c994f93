// What the arguments of several verbs have in common.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/message_text.h"
#include "console/home.h"

namespace seedframe {

/// A number that is 0 or more.
class NotNegative : public CLI::Validator {
 public:
  NotNegative()
      : Validator(
            [](std::string& text) {
              double value = 0.0;
              const bool good = CLI::detail::lexical_cast(text, value) && value >= 0.0;
              return good ? std::string()
                          : "expected a number of 0 or more, found '" + shortened(text, 60) + "'";
            },
            "NONNEGATIVE") {}
};

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
