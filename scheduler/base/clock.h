// The time of day, for messages to people; no result depends on it.
#pragma once

#include <chrono>

namespace seedframe {

/// Seconds since 1970.
inline double unix_time() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace seedframe
