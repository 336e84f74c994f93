#include "assets/asset_library.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "assets/asset_files.h"
#include "assets/asset_level_file.h"
#include "assets/uv_scale.h"
#include "base/nearest_name.h"
#include "base/sha256.h"
#include "mesh/mesh_buffer.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

// Sorted names of the assets right under `root`.
Result<std::vector<std::string>> find_assets(const fs::path& root) {
  std::error_code error;
  if (!fs::is_directory(root, error)) {
    return fail(ErrorKind::kInput, "the asset folder {} does not exist or is not a folder",
                root.string());
  }
  std::vector<std::string> names;
  for (fs::directory_iterator entry(root, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code unreadable;
    const bool described = fs::exists(entry->path() / asset_files::kDescription, unreadable);
    if (is_asset_name(name) && described) names.push_back(name);
  }
  if (error) {
    return fail(ErrorKind::kEnvironment, "cannot list the asset folder {}: {}", root.string(),
                error.message());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Status check_files(const fs::path& folder, const AllowedFolders& allowed) {
  if (Status inside = allowed.check(folder, folder.string()); !inside) return inside;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& file = entry->path();
    if (Status inside = allowed.check(file, file.string()); !inside) return inside;
  }
  return {};
}

}  // namespace

Result<Asset> read_asset(const fs::path& folder, const fs::path& copies) {
  const auto description = read_asset_description(folder);
  if (!description) return forward_error(description);
  auto mesh = read_level_mesh(folder, *description, 0, copies);
  if (!mesh) return forward_error(mesh);
  Asset asset;
  asset.name = description->name;
  asset.folder = folder;
  asset.category = description->category;
  asset.description = description->description;
  asset.mesh = std::move(*mesh);
  asset.metres_per_uv = has_uvs(asset.mesh) ? metres_per_uv(asset.mesh) : 1.0;
  if (!has_uvs(asset.mesh)) project_uvs(asset.mesh);
  asset.mesh_sha256 = description->levels[0].sha256;
  asset.buffer = mesh_buffer(asset.mesh);
  asset.buffer_sha256 = sha256_hex(asset.buffer);
  asset.bytes = description->levels[0].bytes;
  asset.levels.reserve(description->levels.size());
  for (const LevelRecord& level : description->levels) {
    asset.levels.push_back({level.triangles, level.error_m, level.sha256});
  }
  asset.box = bounding_box(asset.mesh);
  asset.keypoints = description->keypoints;
  asset.materials = description->materials;
  for (auto& [slot, material] : asset.materials) {
    for (auto& [role, file] : material.files) file = (folder / file).string();
  }
  asset.lowest = LowestPoint(asset.mesh);
  return asset;
}

struct AssetLibrary::State {
  AllowedFolders allowed;
  fs::path copies;
  std::map<std::string, fs::path> folders;
  std::mutex mutex;
  // Guarded by mutex.
  std::map<std::string, std::shared_ptr<const Asset>> loaded;
  std::map<std::pair<std::string, std::size_t>, std::shared_ptr<const LevelMesh>> levels;
};

AssetLibrary::AssetLibrary(std::shared_ptr<State> state) : state_(std::move(state)) {}

Result<AssetLibrary> AssetLibrary::open(const std::vector<fs::path>& roots, AllowedFolders allowed,
                                        const fs::path& copies) {
  auto state = std::make_shared<State>();
  state->allowed = std::move(allowed);
  state->copies = copies;
  for (const fs::path& root : roots) state->allowed.add(root);
  for (const fs::path& root : roots) {
    const auto names = find_assets(root);
    if (!names) return forward_error(names);
    for (const std::string& name : *names) state->folders.try_emplace(name, root / name);
  }
  return AssetLibrary(std::move(state));
}

std::vector<std::string> AssetLibrary::names() const {
  std::vector<std::string> names;
  for (const auto& [name, folder] : state_->folders) names.push_back(name);
  return names;
}

Result<fs::path> AssetLibrary::folder(const std::string& name) const {
  const auto found = state_->folders.find(name);
  if (found == state_->folders.end()) {
    return fail(ErrorKind::kInput, "there is no asset '{}'{}", name, did_you_mean(name, names()));
  }
  if (Status inside = check_files(found->second, state_->allowed); !inside) {
    return forward_error(inside);
  }
  return found->second;
}

Result<std::shared_ptr<const Asset>> AssetLibrary::load(const std::string& name) const {
  // Held while reading: two threads that want one asset must not both decode it.
  const std::lock_guard lock(state_->mutex);
  if (const auto found = state_->loaded.find(name); found != state_->loaded.end()) {
    return found->second;
  }
  const auto asset_folder = folder(name);
  if (!asset_folder) return forward_error(asset_folder);
  auto asset = read_asset(*asset_folder, state_->copies);
  if (!asset) return forward_error(asset);
  auto shared = std::make_shared<const Asset>(std::move(*asset));
  state_->loaded.emplace(name, shared);
  return shared;
}

Result<std::shared_ptr<const LevelMesh>> AssetLibrary::load_level(const std::string& name,
                                                                  std::size_t level) const {
  const std::lock_guard lock(state_->mutex);
  const auto key = std::pair(name, level);
  if (const auto found = state_->levels.find(key); found != state_->levels.end()) {
    return found->second;
  }
  const auto asset_folder = folder(name);
  if (!asset_folder) return forward_error(asset_folder);
  const auto description = read_asset_description(*asset_folder);
  if (!description) return forward_error(description);
  if (level >= description->levels.size()) {
    return fail(ErrorKind::kInput, "asset '{}' has {} levels of detail, there is no level {}", name,
                description->levels.size(), level);
  }
  auto mesh = read_level_mesh(*asset_folder, *description, level, state_->copies);
  if (!mesh) return forward_error(mesh);
  if (!has_uvs(*mesh)) project_uvs(*mesh);
  LevelMesh read{.mesh = std::move(*mesh), .buffer = {}, .buffer_sha256 = {}};
  read.buffer = mesh_buffer(read.mesh);
  read.buffer_sha256 = sha256_hex(read.buffer);
  auto shared = std::make_shared<const LevelMesh>(std::move(read));
  state_->levels.emplace(key, shared);
  return shared;
}

}  // namespace seedframe
