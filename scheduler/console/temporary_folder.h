// A folder of the system's for temporary files, that goes with its object.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>

#include "base/error.h"

namespace seedframe {

class TemporaryFolder {
 public:
  /// In what TMPDIR names, or /tmp. kEnvironment error: it cannot be made.
  static Result<TemporaryFolder> make(const std::string& name) {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    std::string path = (parent / (name + "-XXXXXX")).string();
    if (error || ::mkdtemp(path.data()) == nullptr) {
      return fail(ErrorKind::kEnvironment, "cannot make a folder for temporary files in {}: {}",
                  parent.string(), error ? error.message() : std::strerror(errno));
    }
    return TemporaryFolder(std::move(path));
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace seedframe
