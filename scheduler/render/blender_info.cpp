#include "render/blender_info.h"

#include <algorithm>
#include <array>
#include <future>
#include <regex>

#include <fmt/format.h>

#include "render/child_process.h"

namespace seedframe {
namespace {

constexpr const char* kRemedy = "install Blender 3.3 or newer, or name it with --blender PATH";
constexpr auto kProbeTimeout = std::chrono::seconds(60);  // a cold disk is slow

struct Release {
  int major, minor;
};
constexpr std::array<Release, 5> kTested = {{{3, 4}, {4, 2}, {4, 5}, {5, 0}, {5, 2}}};

Result<std::string> version_text(const BlenderProgram& program) {
  if (program.module.empty()) {
    return output_of({program.path.string(), "--version"}, kProbeTimeout);
  }
  const Result<std::string> version = module_version(program);
  if (!version) return forward_error(version);
  return "Blender " + *version;
}

}  // namespace

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
  info.tested = std::any_of(kTested.begin(), kTested.end(), [&](const Release& each) {
    return each.major == info.major && each.minor == info.minor;
  });
  return info;
}

Result<BlenderInfo> probe_blender(const std::string& name) {
  Result<BlenderProgram> program = find_blender(name);
  if (!program) return forward_error(program);
  // Reading it takes a while, and asking it is waiting for another process.
  auto hashing = std::async(std::launch::async, [&] { return sha256_of(*program); });
  const Result<std::string> text = version_text(*program);
  Result<std::string> sha256 = hashing.get();
  if (!text) return forward_error(text);
  Result<BlenderInfo> info = parse_blender_version(*text);
  if (!info) {
    return fail(ErrorKind::kEnvironment, "{}: {}", program->name(), info.error().message);
  }
  if (!sha256) return forward_error(sha256);
  info->program = std::move(*program);
  info->sha256 = std::move(*sha256);
  return info;
}

std::string tested_blender_versions() {
  std::string text;
  for (std::size_t i = 0; i < kTested.size(); ++i) {
    text += fmt::format("{}{}.{}",
                        i == 0                    ? ""
                        : i + 1 == kTested.size() ? " and "
                                                  : ", ",
                        kTested[i].major, kTested[i].minor);
  }
  return text;
}

}  // namespace seedframe
