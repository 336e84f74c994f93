// One attempt at one frame: the unit that is handed to a worker, judged and counted.
#pragma once

#include <compare>
#include <cstdint>
#include <string>

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
  int crashes = 0;        ///< attempts of these that cost a worker
};

/// How an attempt came to nothing. Errors and crashes are counted apart.
enum class Failure {
  kAnswered,  ///< an error: the worker said in good order that it cannot render the frame
  kBadFile,   ///< an error: what the worker wrote is not the frame
  kCrash,     ///< the worker died, hung or talked nonsense, and is gone
};

/// What becomes of the frame of an attempt that failed.
enum class Consequence {
  kRetry,
  kFailed,       ///< for good: no error left to make
  kQuarantined,  ///< for good: it has cost too many workers
};

/// An attempt that failed, as its frame's owner is told.
struct AttemptFailure {
  Failure failure = Failure::kAnswered;
  Consequence consequence = Consequence::kRetry;
  std::string message;
  std::string log;  ///< of a crash: the last words of the worker, up to 64 KiB
};

}  // namespace seedframe
