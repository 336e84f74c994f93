#include "draws/evaluation_context.h"

#include <fmt/format.h>

namespace seedframe {
namespace {

// Scattered copies try up to this many places within one attempt to meet the constraints.
constexpr std::uint32_t kPlacementStride = 4096;

}  // namespace

PhiloxStream::Position EvaluationContext::position(Level level) const {
  const std::uint32_t redrawn = level == Level::kFrame ? frame_attempt * kPlacementStride : 0;
  return {.scene = level == Level::kCampaign ? kNoIndex : draw_scene,
          .frame = level == Level::kFrame ? frame : kNoIndex,
          .copy = copy,
          .attempt = redrawn + placement_attempt};
}

void EvaluationContext::report(const Place& place, const std::string& message) {
  if (error) return;
  const std::string where = place.path.empty() && place.file.empty() ? "" : place.text() + ": ";
  report_frame(where + message);
}

void EvaluationContext::report_frame(const std::string& message) {
  if (error) return;
  error = Error{ErrorKind::kInput,
                fmt::format("{} (scene {}, frame {} of it{})", message, scene, frame,
                            copy == kNoIndex ? std::string() : fmt::format(", copy {}", copy))};
}

std::uint32_t first_attempt_of(std::uint32_t layout) {
  constexpr std::uint32_t kRounds = 32;  // the first of them are far apart, the others in between
  constexpr std::uint32_t kApart = 1U << 27U;
  static_assert(kMostLayouts / kRounds * kMostAttemptsOfLayout <= kApart);
  return layout % kRounds * kApart + layout / kRounds * kMostAttemptsOfLayout;
}

bool EvaluationContext::take_next_layout() {
  if (!crowded || *crowded == Level::kFrame || layout + 1 == kMostLayouts) return false;
  forget_error();
  ++layout;
  return true;
}

void EvaluationContext::forget_error() {
  error.reset();
  crowded.reset();
}

std::string draw_name(const std::string& name, const EvaluationContext& context) {
  return context.copy == kNoIndex ? name : fmt::format("{}/{}", name, context.copy);
}

}  // namespace seedframe
