// What was made last, because the next frame often wants the same again.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace seedframe {

/// One value and the key that it was made from. Safe to use from several threads, which may make
/// the same value at the same time: then the later one is kept.
template <class Key, class Value>
class LastMade {
 public:
  /// Null if the last one has another key.
  std::shared_ptr<const Value> find(const Key& key) const {
    const std::lock_guard lock(mutex_);
    return value_ != nullptr && key_ == key ? value_ : nullptr;
  }

  void keep(Key key, std::shared_ptr<const Value> value) {
    const std::lock_guard lock(mutex_);
    key_ = std::move(key);
    value_ = std::move(value);
  }

 private:
  mutable std::mutex mutex_;
  Key key_{};
  std::shared_ptr<const Value> value_;
};

}  // namespace seedframe
