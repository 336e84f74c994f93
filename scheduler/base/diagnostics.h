// Errors of a config, collected so that one run names them all.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "base/place.h"

namespace seedframe {

class Diagnostics {
 public:
  void add(const Place& place, const std::string& message);
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  /// One kInput error with a line for each message, the first 20 in full.
  Error as_error() const;

 private:
  std::vector<std::string> messages_;  ///< the first ones: a config can have a million mistakes
  std::size_t size_ = 0;
};

}  // namespace seedframe
