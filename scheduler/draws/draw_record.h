// Draws that were made, for people to look at.
#pragma once

#include <string>

#include "base/canonical_json.h"

namespace seedframe {

/// "objects.bolts.rotation_deg[2]/3" = 117.2.
struct Draw {
  std::string name;
  Json value;  ///< a number or a name
};

}  // namespace seedframe
