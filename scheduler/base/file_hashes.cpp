#include "base/file_hashes.h"

#include "base/sha256.h"

namespace seedframe {

Result<std::shared_ptr<const HashedFile>> FileHashes::of(const std::filesystem::path& file,
                                                         const AllowedFolders& allowed) {
  // Held while reading: two threads that want one file must not both read it.
  const std::lock_guard lock(mutex_);
  const auto known = hashed_.find(file.native());
  if (known != hashed_.end()) return known->second;
  if (const Status inside = allowed.check(file, file.string()); !inside) {
    return forward_error(inside);
  }
  Result<std::string> computed = sha256_of_file(file);
  if (!computed) return forward_error(computed);
  auto hashed = std::make_shared<const HashedFile>(HashedFile{file, std::move(*computed)});
  hashed_.emplace(file.native(), hashed);
  return hashed;
}

}  // namespace seedframe
