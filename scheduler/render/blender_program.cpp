#include "render/blender_program.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "base/sha256.h"
#include "render/child_process.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kPython = "python:";
constexpr const char* kProgramRemedy =
    "install Blender 3.3 or newer, or name it with --blender PATH or --blender python:VENV";
constexpr const char* kModuleRemedy =
    "name the folder of a virtual environment that has it, such as scripts/setup.sh --blender 4.5 "
    "makes";

Result<fs::path> find_program(const std::string& program) {
  if (program.find('/') != std::string::npos) {
    std::error_code error;
    const fs::path path = fs::absolute(program, error);
    if (!fs::exists(path, error)) {
      return fail(ErrorKind::kEnvironment, "Blender not found: there is no {}; {}", program,
                  kProgramRemedy);
    }
    if (!is_program(path)) {
      return fail(ErrorKind::kEnvironment, "{} is not a program that may be executed; {}", program,
                  kProgramRemedy);
    }
    return path;
  }
  if (const auto path = find_in_path(program)) return *path;
  return fail(ErrorKind::kEnvironment, "Blender not found: no program '{}' in PATH; {}", program,
              kProgramRemedy);
}

/// The entries of a folder whose name begins and ends so, in order.
std::vector<fs::path> entries(const fs::path& folder, std::string_view begin,
                              std::string_view end) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(begin) && name.ends_with(end)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

fs::path library_of(const BlenderProgram& blender) { return blender.module / "__init__.so"; }

Result<BlenderProgram> find_module(const std::string& place) {
  std::error_code error;
  // Not canonical: the Python of a virtual environment is a link to that of the system.
  fs::path python = fs::absolute(place, error).lexically_normal();
  if (fs::is_directory(python, error)) python = python / "bin" / "python";
  const Result<fs::path> program = find_program(python.string());
  if (!program) return forward_error(program);
  const fs::path prefix = program->parent_path().parent_path();
  for (const fs::path& version : entries(prefix / "lib", "python3.", "")) {
    BlenderProgram blender{*program, version / "site-packages" / "bpy"};
    if (fs::is_regular_file(library_of(blender), error)) return blender;
  }
  return fail(ErrorKind::kEnvironment,
              "the Python {} has no Blender: there is no module bpy in {}/lib/python3.*/"
              "site-packages; {}",
              program->string(), prefix.string(), kModuleRemedy);
}

/// The folder with what the installer noted; empty if there is none.
fs::path notes_of_installer(const BlenderProgram& blender) {
  const auto found = entries(blender.module.parent_path(), "bpy-", ".dist-info");
  return found.empty() ? fs::path() : found.front();
}

/// From URL-safe base 64 without padding; empty if it is something else.
std::string hex_of_base64(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  constexpr unsigned kBits = 6;
  std::string hex;
  unsigned bits = 0, waiting = 0;
  for (const char character : text) {
    const std::size_t digit = kDigits.find(character);
    if (digit == std::string_view::npos) return {};
    bits = (bits << kBits) | static_cast<unsigned>(digit);
    for (waiting += kBits; waiting >= 4; waiting -= 4) {
      hex += "0123456789abcdef"[(bits >> (waiting - 4)) & 0xfU];
    }
  }
  return hex;
}

/// A line of RECORD is a file, its hash and its size, with commas between.
std::string noted_sha256(const BlenderProgram& blender) {
  constexpr std::string_view kLine = "bpy/__init__.so,sha256=";
  constexpr std::size_t kHexDigits = 64;
  std::error_code error;
  std::ifstream record(notes_of_installer(blender) / "RECORD");
  for (std::string line; std::getline(record, line);) {
    if (!line.starts_with(kLine)) continue;
    const std::size_t comma = line.find(',', kLine.size());
    if (comma == std::string::npos) return {};
    const auto bytes = fs::file_size(library_of(blender), error);
    if (line.substr(comma + 1, line.find('\r') - comma - 1) != std::to_string(bytes)) return {};
    const std::string hex =
        hex_of_base64(std::string_view(line).substr(kLine.size(), comma - kLine.size()));
    // 43 digits of six bits hold two bits more than 32 bytes, which stay behind.
    return hex.size() == kHexDigits ? hex : std::string();
  }
  return {};
}

}  // namespace

std::string BlenderProgram::name() const {
  return module.empty() ? path.string() : std::string(kPython) + path.string();
}

Result<BlenderProgram> find_blender(const std::string& name) {
  if (name.starts_with(kPython)) return find_module(name.substr(kPython.size()));
  Result<fs::path> program = find_program(name);
  if (!program) return forward_error(program);
  return BlenderProgram{std::move(*program), {}};
}

Result<std::string> module_version(const BlenderProgram& blender) {
  const std::string name = notes_of_installer(blender).stem().string();
  if (!name.empty()) return name.substr(name.find('-') + 1);
  return fail(ErrorKind::kEnvironment,
              "{} does not tell its version: there is no bpy-*.dist-info beside it; {}",
              blender.module.string(), kModuleRemedy);
}

Result<std::string> sha256_of(const BlenderProgram& blender) {
  if (blender.module.empty()) return sha256_of_file(blender.path);
  std::string noted = noted_sha256(blender);
  if (!noted.empty()) return noted;
  return sha256_of_file(library_of(blender));
}

std::vector<std::string> blender_command(const BlenderProgram& blender, const fs::path& scripts,
                                         int threads, const fs::path& script) {
  const std::string count = std::to_string(threads);
  if (!blender.module.empty()) {
    return {blender.path.string(),
            "-I",
            "-B",
            (scripts / "bpy_starter.py").string(),
            "--threads",
            count,
            script.string(),
            "--"};
  }
  return {blender.path.string(),
          "--background",
          "--factory-startup",
          "--disable-autoexec",
          "-noaudio",
          "--threads",
          count,
          "--python-exit-code",
          "3",
          "--python",
          script.string(),
          "--"};
}

}  // namespace seedframe
