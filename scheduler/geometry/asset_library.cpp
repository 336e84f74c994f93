#include "geometry/asset_library.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "base/nearest_name.h"
#include "base/portable_math.h"
#include "geometry/asset_files.h"
#include "geometry/draco_codec.h"
#include "geometry/mesh_buffer.h"
#include "geometry/obj_reader.h"

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

// The stream says how many slots it uses, asset.json how they are called.
Status name_slots(Mesh& mesh, const AssetDescription& description, const std::string& what) {
  if (description.slots.size() < mesh.slot_names.size()) {
    return fail(ErrorKind::kCorrupt, "{}: the mesh uses {} material slots, but {} are named", what,
                mesh.slot_names.size(), description.slots.size());
  }
  mesh.slot_names = description.slots;
  return {};
}

}  // namespace

Result<Asset> read_asset(const fs::path& folder) {
  const auto description = read_asset_description(folder);
  if (!description) return forward_error(description);
  const fs::path mesh_path = folder / asset_files::kMesh;
  const std::string what = mesh_path.string();
  const auto stream = read_file(mesh_path);
  if (!stream) return forward_error(stream);
  Asset asset;
  asset.mesh_sha256 = sha256_hex(*stream);
  if (asset.mesh_sha256 != description->mesh_sha256) {
    return fail(ErrorKind::kCorrupt,
                "{} is damaged: its SHA-256 is {}, but {} says {}; import the asset again", what,
                asset.mesh_sha256, asset_files::kDescription, description->mesh_sha256);
  }
  auto mesh = decode_draco(*stream, what);
  if (!mesh) return forward_error(mesh);
  if (Status status = name_slots(*mesh, *description, what); !status) return forward_error(status);
  if (mesh->triangles.size() != description->triangles) {
    return fail(ErrorKind::kCorrupt, "{}: {} says {} triangles, but there are {}", what,
                asset_files::kDescription, description->triangles, mesh->triangles.size());
  }
  mesh->smooth_angle_rad = portable::radians(description->smooth_angle_deg);
  asset.name = description->name;
  asset.category = description->category;
  asset.description = description->description;
  asset.mesh = std::move(*mesh);
  asset.buffer = mesh_buffer(asset.mesh);
  asset.buffer_sha256 = sha256_hex(asset.buffer);
  asset.bytes = stream->size();
  asset.box = bounding_box(asset.mesh);
  asset.lowest = LowestPoint(asset.mesh);
  return asset;
}

struct AssetLibrary::State {
  std::map<std::string, fs::path> folders;
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<const Asset>> loaded;  // guarded by mutex
};

AssetLibrary::AssetLibrary(std::shared_ptr<State> state) : state_(std::move(state)) {}

Result<AssetLibrary> AssetLibrary::open(const std::vector<fs::path>& roots) {
  auto state = std::make_shared<State>();
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

Result<std::shared_ptr<const Asset>> AssetLibrary::load(const std::string& name) const {
  const auto folder = state_->folders.find(name);
  if (folder == state_->folders.end()) {
    return fail(ErrorKind::kInput, "there is no asset '{}'{}", name, did_you_mean(name, names()));
  }
  // Held while reading: two threads that want one asset must not both decode it.
  const std::lock_guard lock(state_->mutex);
  if (const auto found = state_->loaded.find(name); found != state_->loaded.end()) {
    return found->second;
  }
  auto asset = read_asset(folder->second);
  if (!asset) return forward_error(asset);
  auto shared = std::make_shared<const Asset>(std::move(*asset));
  state_->loaded.emplace(name, shared);
  return shared;
}

Status import_asset(const AssetImport& request) {
  if (!is_asset_name(request.name)) {
    return fail(ErrorKind::kInput,
                "'{}' cannot name an asset: use letters, digits, '_' and '-', 64 at most",
                request.name);
  }
  if (!std::isfinite(request.scale) || request.scale <= 0.0) {
    return fail(ErrorKind::kInput, "the scale must be more than 0 metres per unit, found {}",
                request.scale);
  }
  if (!(request.smooth_angle_deg >= 0.0 && request.smooth_angle_deg <= 180.0)) {
    return fail(ErrorKind::kInput, "the smoothing angle must be 0 to 180 degrees, found {}",
                request.smooth_angle_deg);
  }
  const fs::path folder = request.root / request.name;
  std::error_code error;
  if (!request.replace && fs::exists(folder, error)) {
    return fail(ErrorKind::kInput, "{} exists; choose another name, or replace it with --force",
                folder.string());
  }
  auto mesh = read_obj(request.file);
  if (!mesh) return forward_error(mesh);
  for (auto& position : mesh->positions) {
    for (float& value : position) value = static_cast<float>(value * request.scale);
  }
  if (Status status = check_mesh(*mesh, request.file.string()); !status) return status;
  return write_asset(folder, *mesh, request);
}

}  // namespace seedframe
