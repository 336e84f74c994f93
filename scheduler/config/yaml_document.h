// A text as one tree of YAML.
#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

#include "base/error.h"

namespace seedframe {

/// Errors (kInput) name `file` with line and column: what check_config_text refuses, what is not
/// YAML, a second document. A text without a value is an undefined node or a null.
Result<YAML::Node> read_yaml_document(const std::string& text, const std::string& file);

}  // namespace seedframe
