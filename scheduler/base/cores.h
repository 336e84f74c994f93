// How much the machine does at once.
#pragma once

#include <algorithm>
#include <thread>

namespace seedframe {

/// Threads that run beside each other; at least 1.
inline int core_count() {
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace seedframe
