// How long a worker may take over a frame before it counts as hung.
#pragma once

#include <chrono>
#include <deque>

namespace seedframe {

/// Learns from the frames that were rendered: ten times the longest of the last hundred, at least
/// half a minute and at most `longest`, which alone counts until eight frames are known. A frame
/// that has cost workers before gets four times as much for each of them, so that one that is just
/// slow gets through.
class FrameTimeout {
 public:
  using Milliseconds = std::chrono::milliseconds;

  explicit FrameTimeout(Milliseconds longest) : longest_(longest) {}

  void rendered(Milliseconds took);
  Milliseconds limit(int crashes) const;

 private:
  Milliseconds longest_;
  std::deque<Milliseconds> last_;
};

}  // namespace seedframe
