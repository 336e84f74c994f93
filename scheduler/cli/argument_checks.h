// Checks of arguments, with errors that say what was expected.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "base/message_text.h"

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

}  // namespace seedframe
