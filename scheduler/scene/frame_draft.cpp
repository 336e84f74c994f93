#include "scene/frame_draft.h"

#include <cmath>

namespace seedframe {

double at_least(const NumberDraw& draw, double least, bool open, const char* what,
                EvaluationContext& context) {
  const double value = draw.evaluate(context);
  if (open ? value > least : value >= least) return value;
  context.report(draw.place(), fmt::format("{} must be {} {}, found {}", what,
                                           open ? "above" : "at least", least, value));
  return least + 1.0;
}

double positive(const NumberDraw& draw, const char* what, EvaluationContext& context) {
  return at_least(draw, 0.0, true, what, context);
}

double not_negative(const NumberDraw& draw, const char* what, EvaluationContext& context) {
  return at_least(draw, 0.0, false, what, context);
}

double within(const NumberDraw& draw, double least, double most, const char* what,
              EvaluationContext& context) {
  const double value = draw.evaluate(context);
  if (value >= least && value <= most) return value;
  context.report(draw.place(),
                 fmt::format("{} must be from {} to {}, found {}", what, least, most, value));
  return least;
}

std::uint32_t copies_of(const NumberDraw& count, std::uint32_t most, EvaluationContext& context) {
  const double value = std::floor(count.evaluate(context) + 0.5);
  if (value >= 0.0 && value <= most) return static_cast<std::uint32_t>(value);
  context.report(count.place(), fmt::format("a count must be from 0 to {}, found {}", most, value));
  return 0;
}

}  // namespace seedframe
