// "Did you mean": the known name nearest to a mistyped one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace seedframe {

/// The candidate with the smallest edit distance (insertions, deletions, substitutions, swaps of
/// neighbours), if that is at most a third of its length; otherwise empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// " (did you mean 'x'?)", with several if they begin with that name and "_" or "-", or a list of
/// what there is when nothing is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace seedframe
