// Errors of a config, collected so that one run names them all.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

/// Where something stands in a config: printed as "parts.yaml:12:5: objects.bolts.count".
struct Place {
  std::string file;  ///< the config's path as given, or "--set path=value"
  int line = 0;      ///< from 1; 0 when there is none
  int column = 0;    ///< from 1
  std::string path;  ///< of the key, such as "objects.bolts.position[0]"

  std::string text() const;
};

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
