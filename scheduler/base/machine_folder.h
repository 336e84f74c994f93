// Where the processes of one machine work that have no folder of the user's: what they share there,
// copies of assets and mesh buffers by their hashes, and a folder of its own for each, none of
// which outlives its process for long.
#pragma once

#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/folder_lock.h"

namespace seedframe {

class MachineFolder {
 public:
  /// `wanted` is made, or seedframe-<user id> in TMPDIR or /tmp if it is empty, for this user
  /// alone; kEnvironment: it is somebody else's. Removes what was left by
  /// processes that were killed.
  static Result<MachineFolder> open(const std::filesystem::path& wanted);

  std::filesystem::path assets() const { return root_ / "assets"; }
  std::filesystem::path meshes() const { return root_ / "meshes"; }

  /// A folder that goes with it.
  class Own {
   public:
    Own(std::filesystem::path path, FolderLock lock)
        : path_(std::move(path)), lock_(std::move(lock)) {}
    Own(Own&& other) noexcept
        : path_(std::exchange(other.path_, {})), lock_(std::move(other.lock_)) {}
    Own& operator=(Own&&) = delete;
    ~Own();
    /// To be made.
    std::filesystem::path folder() const { return path_ / "files"; }

   private:
    std::filesystem::path path_;
    FolderLock lock_;
  };
  Result<Own> make_own() const;

 private:
  explicit MachineFolder(std::filesystem::path root) : root_(std::move(root)) {}
  void remove_abandoned() const;

  std::filesystem::path root_;
};

}  // namespace seedframe
