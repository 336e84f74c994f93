#include "console/home.h"

#include <cstdlib>
#include <vector>

namespace seedframe {
namespace {

namespace fs = std::filesystem;

fs::path program_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

bool is_below(const fs::path& file, const fs::path& folder) {
  const fs::path relative = file.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

fs::path environment_path(const char* name) {
  const char* text = std::getenv(name);
  return text != nullptr ? text : "";
}

// seedframe/ in the folder that the environment names, or that is usual for it below the user's
// home; empty if there is neither (XDG Base Directory Specification).
fs::path users_folder(const char* variable, const char* below_home) {
  const fs::path named = environment_path(variable);
  if (named.is_absolute()) return named / "seedframe";
  const fs::path home = environment_path("HOME");
  return home.is_absolute() ? home / below_home / "seedframe" : fs::path();
}

bool is_home(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "blender_scripts/render_worker.py", error) &&
         fs::is_directory(folder / "assets", error) &&
         fs::is_directory(folder / "materials", error);
}

}  // namespace

Result<fs::path> find_home() {
  const char* named = std::getenv("SEEDFRAME_HOME");
  if (named != nullptr && *named != '\0') {
    if (is_home(named)) return fs::path(named);
    return fail(ErrorKind::kEnvironment,
                "SEEDFRAME_HOME is '{}', which has no blender_scripts/, assets/ and materials/: "
                "let it name a checkout or share/seedframe of an installation, or unset it",
                named);
  }
  const fs::path program = program_folder();
  std::vector<fs::path> places = {(program / SEEDFRAME_DATA_FROM_PROGRAM).lexically_normal()};
  // Elsewhere, the builder's folder is none of ours, and could be anybody's.
  if (is_below(program, SEEDFRAME_BUILD_FOLDER)) places.emplace_back(SEEDFRAME_CHECKOUT);
  std::string list;
  for (const fs::path& place : places) {
    if (is_home(place)) return place;
    list += (list.empty() ? "" : " and ") + place.string();
  }
  return fail(ErrorKind::kEnvironment,
              "the program's own blender_scripts/, assets/ and materials/ are not there: looked in "
              "{}. Install Seedframe again, as a whole, or let SEEDFRAME_HOME name a checkout",
              list);
}

fs::path seedframe_home() { return find_home().value_or(fs::path()); }

fs::path cache_folder() {
  fs::path own = environment_path("SEEDFRAME_CACHE");
  if (own == "off") return {};
  if (!own.empty()) return own;
  return users_folder("XDG_CACHE_HOME", ".cache");
}

fs::path own_assets() {
  const fs::path folder = users_folder("XDG_DATA_HOME", ".local/share");
  return folder.empty() ? folder : folder / "assets";
}

fs::path worker_preload() {
  constexpr const char* kLibrary = "seedframe_worker_cpu.so";
  const fs::path program = program_folder();
  std::error_code error;
  const fs::path installed =
      (program / SEEDFRAME_LIBRARIES_FROM_PROGRAM / kLibrary).lexically_normal();
  return fs::exists(installed, error) ? installed : program / kLibrary;
}

std::string default_blender() {
  std::error_code error;
  // Where the link leads, so that what is rendered is told by its version.
  const fs::path venv = fs::canonical(seedframe_home() / "venv/blender", error);
  return error ? "blender" : "python:" + venv.string();
}

}  // namespace seedframe
