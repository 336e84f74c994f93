#include "mesh_files/beside_files.h"

#include <algorithm>

#include "base/files.h"
#include "base/message_text.h"

namespace seedframe {

namespace fs = std::filesystem;

std::optional<fs::path> BesideFiles::find(std::string name) const {
  std::replace(name.begin(), name.end(), '\\', '/');  // as Windows writes them
  if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
  std::error_code error;
  for (const fs::path& path : {folder_ / name, folder_ / fs::path(name).filename()}) {
    if (allowed_.check(path, name) && fs::is_regular_file(path, error)) return path;
  }
  return std::nullopt;
}

std::shared_ptr<const FileImage> BesideFiles::image(const std::string& name) {
  const auto [known, is_new] = images_.try_emplace(name);
  if (!is_new) return known->second;
  const auto path = find(name);
  auto bytes = path ? read_file(*path, kMostImageBytes - image_bytes_) : Result<std::string>();
  if (path && bytes) {
    image_bytes_ += bytes->size();
    known->second = std::make_shared<const FileImage>(FileImage{path->string(), std::move(*bytes)});
  } else {
    builder_.drop("images that cannot be read are left out", "'" + shortened(name, 200) + "'");
  }
  return known->second;
}

}  // namespace seedframe
