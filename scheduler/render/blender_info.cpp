#include "render/blender_info.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "render/child_process.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRemedy = "install Blender 3.3 or newer, or name it with --blender PATH";
constexpr auto kProbeTimeout = std::chrono::seconds(60);  // a cold disk is slow

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

}  // namespace

Result<fs::path> find_blender(const std::string& program) {
  if (program.find('/') != std::string::npos) {
    std::error_code error;
    const fs::path path = fs::absolute(program, error);
    if (!fs::exists(path, error)) {
      return fail(ErrorKind::kEnvironment, "Blender not found: there is no {}; {}", program,
                  kRemedy);
    }
    if (!is_program(path)) {
      return fail(ErrorKind::kEnvironment, "{} is not a program that may be executed; {}", program,
                  kRemedy);
    }
    return path;
  }
  const char* variable = std::getenv("PATH");
  std::string folders = variable == nullptr ? "/usr/bin:/bin" : variable;
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    const fs::path path = fs::path(folders.substr(begin, end - begin)) / program;
    if (is_program(path)) return fs::absolute(path);
    begin = end + 1;
  }
  return fail(ErrorKind::kEnvironment, "Blender not found: no program '{}' in PATH; {}", program,
              kRemedy);
}

Result<BlenderInfo> parse_blender_version(const std::string& output) {
  // Libraries may have warned before Blender speaks.
  static const std::regex version(R"((?:^|\n)Blender (\d{1,4})\.(\d{1,4})(?:\.(\d{1,4}))?)");
  std::smatch match;
  if (!std::regex_search(output, match, version)) {
    return fail(ErrorKind::kEnvironment,
                "expected \"Blender X.Y.Z\" from --version, got \"{}\"; {}", output.substr(0, 200),
                kRemedy);
  }
  BlenderInfo info;
  info.major = std::stoi(match[1]);
  info.minor = std::stoi(match[2]);
  info.patch = match[3].matched ? std::stoi(match[3]) : 0;
  info.version = fmt::format("{}.{}.{}", info.major, info.minor, info.patch);
  if (info.major < 3 || (info.major == 3 && info.minor < 3)) {
    return fail(ErrorKind::kEnvironment, "Blender {} is too old; {}", info.version, kRemedy);
  }
  info.tested = info.major == 3 && info.minor == 4;
  return info;
}

Result<BlenderInfo> probe_blender(const std::string& program) {
  const Result<fs::path> path = find_blender(program);
  if (!path) return forward_error(path);
  const Result<std::string> output = output_of({path->string(), "--version"}, kProbeTimeout);
  if (!output) return forward_error(output);
  Result<BlenderInfo> info = parse_blender_version(*output);
  if (!info) {
    return fail(ErrorKind::kEnvironment, "{}: {}", path->string(), info.error().message);
  }
  info->program = *path;
  return info;
}

}  // namespace seedframe
