#include "audit/sample.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/philox.h"

namespace seedframe {
namespace {

/// Why a frame is looked at before others; empty if nothing is odd about it.
std::string oddity(const FrameRow& row) {
  if (row.crashes > 0) return fmt::format("has cost {} workers", row.crashes);
  if (row.attempts > 1) return fmt::format("was tried {} times", row.attempts);
  if (row.twin.inside_px > 0) {
    return fmt::format("its twin saw {} pixels otherwise", row.twin.inside_px);
  }
  return {};
}

/// The frames of each scene in a random order, and the scenes too.
class Urn {
 public:
  explicit Urn(std::uint64_t seed) : stream_(seed, "audit sample") {}

  void add(const FrameRow& row) {
    const auto scene = static_cast<std::uint32_t>(row.scene);
    const auto frame = static_cast<std::uint32_t>(row.frame);
    scenes_[{stream_.bits({.scene = scene}), row.scene}].push_back(
        {stream_.bits({.scene = scene, .frame = frame}), row.frame});
  }

  /// One of each scene in turn.
  std::vector<std::int64_t> draw(std::size_t count) {
    std::vector<std::int64_t> drawn;
    drawn.reserve(count);
    for (auto& scene : scenes_) std::sort(scene.second.begin(), scene.second.end());
    bool any = true;
    for (std::size_t turn = 0; any && drawn.size() < count; ++turn) {
      any = false;
      for (const auto& [scene, frames] : scenes_) {
        if (turn >= frames.size() || drawn.size() == count) continue;
        drawn.push_back(frames[turn].second);
        any = true;
      }
    }
    return drawn;
  }

 private:
  using Ticket = std::pair<std::uint64_t, std::int64_t>;  ///< random, then what it is of
  PhiloxStream stream_;
  std::map<Ticket, std::vector<Ticket>> scenes_;
};

Result<SampledFrame> row_of(const JobStore& store, std::int64_t frame, std::string why) {
  auto row = store.frame(frame);
  if (!row) return forward_error(row);
  if (!*row) return fail(ErrorKind::kInput, "the campaign has no frame {}", frame);
  if ((*row)->state != FrameState::kDone) {
    return fail(ErrorKind::kInput, "frame {} is {}: only frames that are done can be audited",
                frame, to_string((*row)->state));
  }
  return SampledFrame{std::move(**row), std::move(why)};
}

}  // namespace

Result<AuditSample> choose_sample(const JobStore& store, const SampleWish& wish) {
  AuditSample sample;
  std::vector<std::pair<std::int64_t, std::string>> odd;
  Urn urn(wish.seed);
  const Status visited = store.for_each_frame([&](const FrameRow& row) -> Status {
    ++sample.total;
    if (row.state == FrameState::kFailed || row.state == FrameState::kQuarantined) {
      sample.failed.push_back(row);
    }
    if (row.state != FrameState::kDone) return {};
    ++sample.done;
    if (std::string why = oddity(row); !why.empty()) {
      odd.emplace_back(row.frame, std::move(why));
    } else {
      urn.add(row);
    }
    return {};
  });
  if (!visited) return forward_error(visited);
  std::map<std::int64_t, std::string> chosen;
  for (const std::int64_t frame : wish.only) chosen[frame] = "asked for";
  if (chosen.empty()) {
    const auto share =
        static_cast<std::int64_t>(std::ceil(wish.share * static_cast<double>(sample.done)));
    const auto count = static_cast<std::size_t>(std::max(wish.frames, share));
    for (auto& [frame, why] : odd) {
      if (chosen.size() < count) chosen[frame] = std::move(why);
    }
    for (const std::int64_t frame : urn.draw(count - chosen.size())) chosen[frame] = "drawn";
  }
  sample.frames.reserve(chosen.size());
  for (auto& [frame, why] : chosen) {
    Result<SampledFrame> row = row_of(store, frame, std::move(why));
    if (!row) return forward_error(row);
    sample.frames.push_back(std::move(*row));
  }
  return sample;
}

}  // namespace seedframe
