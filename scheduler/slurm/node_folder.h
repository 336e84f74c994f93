// What tasks on one node share: copies of assets and mesh buffers by their hashes, and a folder of
// its own for each task, none of which outlives its task for long.
#pragma once

#include <filesystem>
#include <optional>

#include "base/error.h"
#include "campaign/campaign_lock.h"

namespace seedframe {

class NodeFolder {
 public:
  /// `wanted` is made, or seedframe-<user id> in TMPDIR or /tmp if it is empty, for this user
  /// alone; kEnvironment: it is somebody else's. Removes what tasks left that were killed.
  static Result<NodeFolder> open(const std::filesystem::path& wanted);

  std::filesystem::path assets() const { return root_ / "assets"; }
  std::filesystem::path meshes() const { return root_ / "meshes"; }

  /// A folder that goes with it.
  class Task {
   public:
    Task(std::filesystem::path path, CampaignLock lock)
        : path_(std::move(path)), lock_(std::move(lock)) {}
    Task(Task&& other) noexcept
        : path_(std::exchange(other.path_, {})), lock_(std::move(other.lock_)) {}
    Task& operator=(Task&&) = delete;
    ~Task();
    std::filesystem::path campaign() const { return path_ / "campaign"; }

   private:
    std::filesystem::path path_;
    CampaignLock lock_;
  };
  Result<Task> make_task() const;

 private:
  explicit NodeFolder(std::filesystem::path root) : root_(std::move(root)) {}
  void remove_dead_tasks() const;

  std::filesystem::path root_;
};

}  // namespace seedframe
