// The variables of a config, told to programs that set them: optimisers, learners.
#pragma once

#include "base/canonical_json.h"
#include "base/error.h"
#include "scene/expander.h"

namespace seedframe {

/// By the names that graphs use (docs/formats/graphs.md): "type" (number, vector or name), "unit",
/// "per_copy", and of the first frame "value" and "distribution", what it was drawn from (of a
/// vector a list of three; null: it is not drawn), with "kind", "level" and its parameters by name;
/// "range" is [least, most] where the distribution has both. An error is that of the frame.
Result<Json> describe_variables(const SceneExpander& expander);

}  // namespace seedframe
