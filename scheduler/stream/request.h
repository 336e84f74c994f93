// What a client of `seedframe stream` asks for, line by line (docs/formats/stream.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "base/canonical_json.h"
#include "base/error.h"
#include "spec/rendering_wish.h"

namespace seedframe {

/// What a frame is made by, from cheap to dear.
enum class Fidelity {
  kLabels,   ///< the twin alone: no picture
  kPreview,  ///< the twin, shaded (preview/twin_shading.h)
  kRender,   ///< Cycles
};
const char* to_string(Fidelity fidelity);

struct FrameRequest {
  Json id;                       ///< as the client gave it
  Json values = Json::object();  ///< of variables, as a line of graphs has them
  std::int64_t scene = 0;        ///< whose draws are made where nothing is given
  Fidelity fidelity = Fidelity::kLabels;
  RenderingWish rendering;  ///< of fidelity render, but for depth
  double deadline_s = 0.0;  ///< from when it came; 0: none
  bool labels = true;       ///< are told in the answer's line
  bool image = false;       ///< and these handed over as arrays
  bool ids = false;
  bool depth = false;

  bool has_arrays() const { return image || ids || depth; }
};

struct CancelRequest {
  Json id;
};
/// The client needs the arrays of an answer no longer.
struct ReleaseRequest {
  Json id;
};
using StreamRequest = std::variant<FrameRequest, CancelRequest, ReleaseRequest>;

/// The id that a line bears, however wrong the rest of it is; null if it has none.
Json id_of_line(std::string_view line);

/// kInput errors say what is wrong with the line, and what would be right.
Result<StreamRequest> read_stream_request(std::string_view line, Fidelity usual);

}  // namespace seedframe
