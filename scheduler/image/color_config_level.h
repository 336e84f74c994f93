// OpenColorIO configs of a later level than the library knows.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include <OpenColorIO/OpenColorIO.h>

#include "base/error.h"

namespace seedframe {

struct ReadColorConfig {
  OCIO_NAMESPACE::ConfigRcPtr config;
  std::set<std::string> left_out;  ///< views that need a later OpenColorIO
};

/// A config's text, whose tables are looked for from `folder`. One of a later level than the
/// library's is read at the library's own level, without what that does not have: transforms that a
/// later OpenColorIO has built in, and the colour spaces, looks and views that are made of them.
/// What is left means the same: a level says what a config may contain, and changes none of it.
/// Throws OpenColorIO's and yaml-cpp's exceptions.
ReadColorConfig read_color_config(const std::string& text, const std::filesystem::path& folder);

/// The text of a config at the level of this library, and the views that were left out of it.
std::string lower_color_config(const std::string& text, std::set<std::string>& left_out);

}  // namespace seedframe
