// Frame specs that come from a file.
#pragma once

#include <string>

#include "base/canonical_json.h"
#include "base/error.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// Reads what to_json wrote; a newer version, a missing key or a wrong type is an error that names
/// `what`.
Result<FrameSpec> frame_spec_from_json(const Json& json, const std::string& what);

}  // namespace seedframe
