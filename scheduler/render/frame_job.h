// One attempt at one frame: the unit that is handed to a worker, judged and counted.
#pragma once

#include <compare>
#include <cstdint>

namespace seedframe {

struct FrameJob {
  std::int64_t frame = 0;
  int attempt = 1;  ///< counted from 1 over the whole life of the campaign

  auto operator<=>(const FrameJob&) const = default;
};

/// A frame that is still to be rendered.
struct PendingFrame {
  std::int64_t frame = 0;
  int attempts_used = 0;  ///< so the next attempt is attempts_used + 1
};

}  // namespace seedframe
