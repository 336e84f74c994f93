// The images that shaded frames need, each read once and kept for the next.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/file_hashes.h"
#include "preview/environment_map.h"
#include "preview/texture.h"

namespace seedframe {

/// Values made of files, by the files' hashes. What was used least recently goes when together they
/// have too many bytes; who holds a value keeps it. Safe to use from several threads.
template <class Value>
class ImageShelf {
 public:
  explicit ImageShelf(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  using Make = std::function<Result<Value>()>;
  /// An error is made anew at the next call.
  Result<std::shared_ptr<const Value>> get(const std::string& sha256, const Make& make) {
    const std::shared_ptr<Entry> entry = entry_of(sha256);
    const std::lock_guard making(entry->mutex);  // others are made meanwhile
    if (entry->value != nullptr) return entry->value;
    Result<Value> made = make();
    if (!made) return forward_error(made);
    entry->value = std::make_shared<const Value>(std::move(*made));
    keep(entry);
    return entry->value;
  }

  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }

 private:
  struct Entry {
    std::mutex mutex;
    std::shared_ptr<const Value> value;
    std::size_t bytes = 0;        ///< 0 until it is kept; guarded by the shelf's mutex, as
    std::uint64_t last_used = 0;  ///< this is
  };

  std::shared_ptr<Entry> entry_of(const std::string& sha256) {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Entry>& entry = entries_[sha256];
    if (entry == nullptr) entry = std::make_shared<Entry>();
    entry->last_used = ++uses_;
    return entry;
  }

  void keep(const std::shared_ptr<Entry>& kept) {
    const std::lock_guard lock(mutex_);
    kept->bytes = kept->value->bytes();
    bytes_ += kept->bytes;
    while (bytes_ > most_bytes_) {
      auto oldest = entries_.end();
      for (auto each = entries_.begin(); each != entries_.end(); ++each) {
        if (each->second->bytes == 0 || each->second == kept) continue;
        if (oldest == entries_.end() || each->second->last_used < oldest->second->last_used) {
          oldest = each;
        }
      }
      if (oldest == entries_.end()) return;
      bytes_ -= oldest->second->bytes;
      entries_.erase(oldest);
    }
  }

  std::size_t most_bytes_;
  mutable std::mutex mutex_;  ///< guards what follows
  std::map<std::string, std::shared_ptr<Entry>> entries_;
  std::uint64_t uses_ = 0;
  std::size_t bytes_ = 0;
};

/// Safe to use from several threads.
class ShadingImages {
 public:
  /// Errors: of read_linear_image, which say what the file is for.
  Result<std::shared_ptr<const Texture>> texture(const HashedFile& file);
  Result<std::shared_ptr<const EnvironmentMap>> environment(const HashedFile& file);

 private:
  ImageShelf<Texture> textures_{std::size_t{256} << 20U};
  ImageShelf<EnvironmentMap> environments_{std::size_t{128} << 20U};
};

}  // namespace seedframe
