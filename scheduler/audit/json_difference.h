// What two JSON values differ in, for people.
#pragma once

#include <string>
#include <vector>

#include "base/canonical_json.h"

namespace seedframe {

/// "render.seed: 7, here 8" for each value that differs, in the order of keys; "objects[3]: only
/// here". After `most` of them one that says how many more there are.
std::vector<std::string> json_differences(const Json& expected, const Json& found,
                                          std::size_t most);

}  // namespace seedframe
