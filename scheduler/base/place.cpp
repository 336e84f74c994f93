#include "base/place.h"

#include <fmt/format.h>

namespace seedframe {

std::string Place::text() const {
  std::string out = file;
  if (line > 0) out += fmt::format(":{}:{}", line, column);
  if (!path.empty()) out += ": " + path;
  return out;
}

}  // namespace seedframe
