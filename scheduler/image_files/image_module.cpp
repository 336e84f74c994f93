#include "image_files/image_module.h"

#include <dlfcn.h>

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFileName = "seedframe_image_module.so";
constexpr const char* kRemedy =
    "install OpenImageIO (libopenimageio2.4, which scripts/setup.sh does) and build or install "
    "Seedframe as a whole";

/// Beside the program in a build folder, in lib/ when installed.
std::vector<fs::path> usual_places() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  return {folder / kFileName, folder.parent_path() / "lib/seedframe" / kFileName};
}

std::string why_not_loaded() {
  const char* reason = dlerror();
  return reason != nullptr ? reason : "no reason given";
}

}  // namespace

Result<const image_module::Table*> open_image_module(const std::vector<fs::path>& places) {
  std::string looked_for;
  for (const fs::path& place : places) {
    looked_for += (looked_for.empty() ? "" : " or ") + place.string();
    std::error_code error;
    if (!fs::exists(place, error)) continue;
    void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);  // never closed
    if (library == nullptr) {
      return fail(ErrorKind::kEnvironment, "cannot load what reads and writes images: {}; {}",
                  why_not_loaded(), kRemedy);
    }
    const auto entry = reinterpret_cast<image_module::Entry>(dlsym(library, image_module::kEntry));
    const image_module::Table* table = entry != nullptr ? entry() : nullptr;
    if (table == nullptr || table->version != image_module::kVersion) {
      return fail(ErrorKind::kEnvironment, "{} is of another Seedframe than this program; {}",
                  place.string(), kRemedy);
    }
    return table;
  }
  return fail(ErrorKind::kEnvironment,
              "the library that reads and writes images is missing: there is no {}; {}", looked_for,
              kRemedy);
}

Result<const image_module::Table*> image_module_table() {
  static const Result<const image_module::Table*> table = open_image_module(usual_places());
  return table;
}

}  // namespace seedframe
