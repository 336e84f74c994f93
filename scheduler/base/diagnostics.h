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
  /// One kInput error with a line for each message, the first 20 by their places in full.
  Error as_error() const;

 private:
  struct Message {
    std::size_t file = 0;  ///< of files_
    int line = 0, column = 0;
    std::string text;
  };
  std::size_t index_of(const std::string& file);

  std::vector<std::string> files_;  ///< in the order of their first messages
  std::vector<Message> messages_;   ///< sorted; not all: a config can have a million mistakes
  std::size_t size_ = 0;
};

}  // namespace seedframe
