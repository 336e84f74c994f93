#include "cli/home.h"

#include <cstdlib>

namespace seedframe {

std::filesystem::path seedframe_home() {
  const char* home = std::getenv("SEEDFRAME_HOME");
  return home != nullptr && *home != '\0' ? home : SEEDFRAME_HOME;
}

std::filesystem::path cache_folder() {
  const auto value = [](const char* name) {
    const char* text = std::getenv(name);
    return std::filesystem::path(text != nullptr ? text : "");
  };
  std::filesystem::path own = value("SEEDFRAME_CACHE");
  if (own == "off") return {};
  if (!own.empty()) return own;
  const std::filesystem::path users = value("XDG_CACHE_HOME");
  if (users.is_absolute()) return users / "seedframe";
  const std::filesystem::path home = value("HOME");
  return home.is_absolute() ? home / ".cache/seedframe" : std::filesystem::path();
}

std::filesystem::path worker_preload() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return program.parent_path() / "seedframe_worker_cpu.so";
}

}  // namespace seedframe
