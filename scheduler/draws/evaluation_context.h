// Where in a campaign values are evaluated, and what formulas may refer to there.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/philox.h"
#include "config/campaign_config.h"
#include "draws/draw_record.h"
#include "formula/formula.h"

namespace seedframe {

/// What a graph gives for one variable, instead of a draw: one value, or one for each copy; or
/// nothing.
struct GivenValues {
  std::vector<std::array<double, 3>> numbers;
  std::vector<std::string> names;
  bool per_copy = false;  ///< even if it is only one
};

inline constexpr std::uint32_t kMostLayouts = 256;
inline constexpr std::uint32_t kMostAttemptsOfLayout = 1U << 12U;  ///< to place a copy

/// Of a draw in a layout, in 32 bits: no two layouts share one.
std::uint32_t first_attempt_of(std::uint32_t layout);

/// Where in the campaign values are being evaluated, and what came of it. All that changes while a
/// frame is expanded is here, so that a compiled config serves several threads.
struct EvaluationContext {
  std::uint32_t scene = 0;
  std::uint32_t frame = 0;  ///< within its scene
  std::uint32_t frames_per_scene = 1;
  /// The scene whose draws are used: another one where a sweep holds them.
  std::uint32_t draw_scene = 0;
  std::uint32_t copy = kNoIndex;        ///< of the object or light being evaluated, for its draws
  std::uint32_t ordinal = 0;            ///< of that copy among all of its section in the frame
  std::uint32_t frame_attempt = 0;      ///< to meet the constraints; changes frame-level draws
  std::uint32_t placement_attempt = 0;  ///< to find a free place
  std::uint32_t layout = 0;      ///< of the places that a scene's frames share; changes those draws
  std::optional<Level> crowded;  ///< a copy whose place is drawn at that level found none
  VariableValues values;         ///< as far as they have been evaluated
  /// By GraphVariable::index; null: no graph gives any.
  std::shared_ptr<const std::vector<GivenValues>> given;
  std::optional<Error> error;  ///< the first; evaluation goes on with zeros
  std::vector<Draw>* record = nullptr;
  Json* graph = nullptr;  ///< takes the values of all variables, as docs/formats/graphs.md says

  PhiloxStream::Position position(Level level) const;
  void report(const Place& place, const std::string& message);
  void report_frame(const std::string& message);
  /// After a frame's copy was crowded out: whether the frame is to be drawn once more, with the
  /// places that its scene shares in another layout. Never because of a place that is the frame's
  /// own.
  bool take_next_layout();
  void forget_error();
};

/// What formulas and names may refer to at one place of the config.
struct CompileScope {
  std::uint64_t seed = 0;
  bool copies = false;  ///< whether there are several copies here
  Scope symbols;
};

/// The key of a draw as people read it: with the copy, where there is one.
std::string draw_name(const std::string& name, const EvaluationContext& context);

}  // namespace seedframe
