// A place in a text that somebody wrote.
#pragma once

#include <string>

namespace seedframe {

/// Where something stands in a config: printed as "parts.yaml:12:5: objects.bolts.count".
struct Place {
  std::string file;  ///< the config's path as given, or "--set path=value"
  int line = 0;      ///< from 1; 0 when there is none
  int column = 0;    ///< from 1
  std::string path;  ///< of the key, such as "objects.bolts.position[0]"

  std::string text() const;
};

}  // namespace seedframe
