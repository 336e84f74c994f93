#include "base/nearest_name.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/message_text.h"

namespace seedframe {
namespace {

// Optimal string alignment: Levenshtein's recurrence with swaps of neighbours.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before[j - 2] + 1);
      }
    }
    before.swap(previous);
    previous.swap(current);
  }
  return previous[b.size()];
}

// Nobody mistypes a longer one, and comparing two takes the product of their lengths.
constexpr std::size_t kLongestName = 64;

/// Those that begin with the words of the name: rotation_deg with rotation, yolo-obb with yolo.
std::vector<std::string> longer_names(std::string_view name,
                                      const std::vector<std::string>& candidates) {
  constexpr std::size_t kMostMeant = 6;
  std::vector<std::string> longer;
  if (name.empty()) return longer;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > name.size() && candidate.starts_with(name) &&
        (candidate[name.size()] == '_' || candidate[name.size()] == '-')) {
      longer.push_back(candidate);
    }
  }
  return longer.size() > kMostMeant ? std::vector<std::string>() : longer;
}

/// "'a', 'b' or 'c'".
std::string alternatives(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += "'" + names[i] + "'";
  }
  return text;
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  constexpr std::size_t kMostCompared = 1000;
  if (name.size() > kLongestName || candidates.size() > kMostCompared) return {};
  std::string best;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestName) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (best.empty() || distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  const std::size_t allowed = std::max<std::size_t>(1, best.size() / 3);
  // A name of which no character is right is another name.
  return best_distance <= allowed && best_distance < name.size() ? best : std::string();
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(name, candidates);
  if (!nearest.empty()) return fmt::format(" (did you mean '{}'?)", nearest);
  const std::vector<std::string> longer = longer_names(name, candidates);
  if (!longer.empty()) return fmt::format(" (did you mean {}?)", alternatives(longer));
  if (candidates.empty()) return {};
  constexpr std::size_t kMostListed = 32;
  const std::size_t shown = std::min(candidates.size(), kMostListed);
  std::string list;
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) list += ", ";
    list += shortened(candidates[i], kLongestName);
  }
  if (shown < candidates.size()) list += ", …";
  return fmt::format(" (there are: {})", list);
}

}  // namespace seedframe
