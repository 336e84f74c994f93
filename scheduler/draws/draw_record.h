// Draws that were made, for people to look at.
#pragma once

#include <optional>
#include <string>

#include "base/canonical_json.h"
#include "draws/draw_law.h"

namespace seedframe {

/// "objects.bolts.rotation_deg[2]/3" = 117.2.
struct Draw {
  std::string name;
  Json value;                                 ///< a number or a name
  std::optional<DrawLaw> law = std::nullopt;  ///< what it follows
};

}  // namespace seedframe
