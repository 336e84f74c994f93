#include "cli/home.h"

#include <cstdlib>

namespace seedframe {

std::filesystem::path seedframe_home() {
  const char* home = std::getenv("SEEDFRAME_HOME");
  return home != nullptr && *home != '\0' ? home : SEEDFRAME_HOME;
}

std::filesystem::path worker_preload() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return program.parent_path() / "seedframe_worker_cpu.so";
}

}  // namespace seedframe
