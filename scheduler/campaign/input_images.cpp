#include "campaign/input_images.h"

#include "assets/image_check.h"
#include "base/diagnostics.h"
#include "base/files.h"
#include "base/sha256.h"
#include "campaign/input_files.h"
#include "image_files/image_kind.h"

namespace seedframe {
namespace {

constexpr std::uintmax_t kLargestImage = std::uintmax_t{1} << 30;

/// The file is read once: what was hashed is what was decoded.
Status check_file(const OfferedImage& image, const AllowedFolders& allowed,
                  const CheckedImages& checked) {
  const std::string what = image.file.string();
  if (Status inside = allowed.check(image.file, what); !inside) return inside;
  const std::optional<ImageKind> kind = image_kind_of(image.file);
  if (!kind) return fail(ErrorKind::kInput, "{}: an image ends in {}", what, image_endings());
  const Result<std::string> bytes = read_file(image.file, kLargestImage);
  if (!bytes) return fail(ErrorKind::kInput, "{}", bytes.error().message);
  const std::string sha256 = sha256_hex(*bytes);
  if (checked.is_known_good(sha256, *kind, image.use)) return {};
  Status good = check_image(*bytes, *kind, image.use, what);
  if (good) checked.remember_good(sha256, *kind, image.use);
  return good;
}

}  // namespace

Status check_input_images(const PreparedCampaign& prepared, const std::filesystem::path& cache) {
  const CheckedImages checked(cache);
  const AllowedFolders& allowed = prepared.expander.allowed_folders();
  Diagnostics errors;
  for (const OfferedImage& image : prepared.expander.offered_images()) {
    Status good = check_file(image, allowed, checked);
    if (good) continue;
    if (good.error().kind != ErrorKind::kInput) return good;
    errors.add(image.place, good.error().message);
  }
  if (errors.empty()) return {};
  return tl::unexpected(errors.as_error());
}

Status check_changed_images(const Campaign& campaign, const PreparedCampaign& prepared,
                            const std::filesystem::path& cache) {
  const auto changed = inputs_changed_since(campaign, prepared);
  if (!changed) return forward_error(changed);
  return changed->empty() ? Status() : check_input_images(prepared, cache);
}

}  // namespace seedframe
