#include "frames/frame_link.h"

#include "base/files.h"
#include "frames/campaign_files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

Status link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_hard_link(from, to, error);
  if (!error) return {};
  fs::copy_file(from, to, error);
  if (error) {
    return fail(kind_of_errno(error.value()), "cannot copy {} to {}: {}", from.string(),
                to.string(), error.message());
  }
  return {};
}

}  // namespace

Result<Manifest> link_frame(const fs::path& committed, const std::string& frame_id,
                            const fs::path& folder) {
  Result<Manifest> manifest = verify_frame(committed, frame_id, VerifyDepth::kContents);
  if (!manifest) return manifest;
  Status linked = link_or_copy(committed / frame_files::kManifest, folder / frame_files::kManifest);
  for (const auto& [name, file] : manifest->files) {
    if (linked) linked = link_or_copy(committed / name, folder / name);
  }
  if (linked) return manifest;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    fs::remove(entry.path(), ignored);
  }
  return forward_error(linked);
}

}  // namespace seedframe
