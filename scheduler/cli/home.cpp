#include "cli/home.h"

#include <cstdlib>

namespace seedframe {

std::filesystem::path seedframe_home() {
  const char* home = std::getenv("SEEDFRAME_HOME");
  return home != nullptr && *home != '\0' ? home : SEEDFRAME_HOME;
}

}  // namespace seedframe
