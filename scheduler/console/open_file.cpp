#include "console/open_file.h"

#include <array>
#include <cstdlib>
#include <string>

#include <spawn.h>
#include <unistd.h>

#include "console/say.h"

namespace seedframe {
namespace {

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

}  // namespace

void open_file(const std::filesystem::path& file) {
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) {
    say_aside(
        "seedframe: note: --open: there is no screen here (neither DISPLAY nor WAYLAND_DISPLAY is "
        "set): open {} yourself\n",
        file.string());
    return;
  }
  std::error_code error;
  std::string program = "xdg-open";
  std::string path = std::filesystem::absolute(file, error).string();  // never an option
  const std::array<char*, 3> arguments = {program.data(), path.data(), nullptr};
  pid_t process = 0;
  if (::posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0) {
    say_aside(
        "seedframe: note: --open: there is no xdg-open here (Debian: xdg-utils): open {} "
        "yourself\n",
        file.string());
  }
}

}  // namespace seedframe
