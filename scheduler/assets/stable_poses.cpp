#include "assets/stable_poses.h"

namespace seedframe {
namespace {

constexpr std::size_t kMostKnown =
    1000;  // each scale that is not the same along all axes is its own

}  // namespace

Result<std::shared_ptr<const std::vector<StableFace>>> StablePoses::of(
    const Asset& asset, const Eigen::Vector3d& scale) {
  // How large something is makes no difference to how it stands.
  const bool alike = scale.x() == scale.y() && scale.y() == scale.z();
  const Eigen::Vector3d shape = alike ? Eigen::Vector3d::Ones().eval() : scale;
  const Key key = {asset.buffer_sha256, {shape.x(), shape.y(), shape.z()}};
  const std::lock_guard lock(mutex_);
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  Result<std::vector<StableFace>> faces = stable_faces(asset.mesh, shape);
  if (!faces) {
    return fail(ErrorKind::kInput, "the asset '{}' has no stable faces: {}", asset.name,
                faces.error().message);
  }
  if (known_.size() == kMostKnown) known_.clear();
  auto kept = std::make_shared<const std::vector<StableFace>>(std::move(*faces));
  known_.emplace(key, kept);
  return kept;
}

}  // namespace seedframe
