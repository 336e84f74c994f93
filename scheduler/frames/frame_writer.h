// Writes the files of one frame and keeps account of them.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "base/sha256.h"
#include "frames/campaign_files.h"
#include "frames/manifest.h"

namespace seedframe {

/// After the first error nothing more is written; status and write_manifest tell it.
class FrameWriter {
 public:
  explicit FrameWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void write(const std::string& name, const std::string& bytes) {
    if (!status_) return;
    status_ = write_file_unsynced(folder_ / name, bytes);
    manifest_.files[name] = {bytes.size(), sha256_hex(bytes)};
  }

  /// The same, in place of a file that is there under another name and goes.
  void write_over(const std::filesystem::path& other, const char* name, const std::string& bytes) {
    if (!status_) return;
    std::error_code error;
    std::filesystem::rename(other, folder_ / name, error);
    status_ = error ? Status(system_failure("rename", other, error.value()))
                    : overwrite_file_unsynced(folder_ / name, bytes);
    manifest_.files[name] = {bytes.size(), sha256_hex(bytes)};
  }

  /// For what `make` writes itself, given the path.
  template <class Make>
  void make(const char* name, Make make) {
    if (!status_) return;
    const std::filesystem::path path = folder_ / name;
    status_ = make(path);
    if (!status_) return;
    const Result<std::string> sha256 = sha256_of_file(path);
    if (!sha256) {
      status_ = forward_error(sha256);
      return;
    }
    std::error_code error;
    manifest_.files[name] = {std::filesystem::file_size(path, error), *sha256};
  }

  Manifest& manifest() { return manifest_; }

  const Status& status() const { return status_; }

  /// The last file; its error is that of the first that could not be written.
  Status write_manifest() {
    if (!status_) return status_;
    return write_file_unsynced(folder_ / frame_files::kManifest, readable_json(to_json(manifest_)));
  }

 private:
  std::filesystem::path folder_;
  Manifest manifest_;
  Status status_;
};

}  // namespace seedframe
