#include "render/frame_timeout.h"

#include <algorithm>

namespace seedframe {

void FrameTimeout::rendered(Milliseconds took) {
  constexpr std::size_t kKnown = 100;
  last_.push_back(took);
  if (last_.size() > kKnown) last_.pop_front();
}

FrameTimeout::Milliseconds FrameTimeout::limit(int crashes) const {
  constexpr std::size_t kEnough = 8;
  constexpr int kPatience = 10;
  constexpr int kMorePatience = 4;
  constexpr auto kShortest = std::chrono::seconds(30);
  if (last_.size() < kEnough) return longest_;
  const Milliseconds longest_seen = *std::max_element(last_.begin(), last_.end());
  Milliseconds limit = std::max<Milliseconds>(kPatience * longest_seen, kShortest);
  for (int i = 0; i < crashes && limit < longest_; ++i) limit *= kMorePatience;
  return std::min(limit, longest_);
}

}  // namespace seedframe
