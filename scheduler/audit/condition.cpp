#include "audit/condition.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "base/nearest_name.h"

namespace seedframe {
namespace {

constexpr std::array<const char*, 10> kConditionNames = {
    "threads", "workers", "order",    "fresh-worker", "history",
    "tmpdir",  "locale",  "timezone", "isa",          "node"};

}  // namespace

const char* to_string(Condition condition) {
  return kConditionNames[static_cast<std::size_t>(condition)];
}

std::string describe(const Conditions& conditions) {
  if (conditions.empty()) return "nothing";
  std::vector<const char*> names;
  names.reserve(conditions.size());
  for (const Condition condition : conditions) names.push_back(to_string(condition));
  return fmt::format("{}", fmt::join(names, ", "));
}

Conditions usual_conditions() {
  Conditions all;
  for (std::size_t i = 0; i < kConditionNames.size(); ++i) all.insert(static_cast<Condition>(i));
  all.erase(Condition::kIsa);
  all.erase(Condition::kNode);
  return all;
}

Conditions promised_conditions(Determinism::Mode mode) {
  Conditions conditions = usual_conditions();
  if (mode == Determinism::Mode::kPortable) conditions.insert(Condition::kIsa);
  return conditions;
}

Result<Conditions> parse_conditions(std::string_view list) {
  Conditions conditions;
  if (list == "none") return conditions;
  if (list == "all") {
    conditions = usual_conditions();
    conditions.insert(Condition::kIsa);
    return conditions;
  }
  while (true) {
    const std::size_t comma = std::min(list.find(','), list.size());
    const std::string name(list.substr(0, comma));
    const auto* found = std::find(kConditionNames.begin(), kConditionNames.end(), name);
    if (found == kConditionNames.end()) {
      return fail(ErrorKind::kInput,
                  "--vary: there is no condition '{}'{}: expected {}, all or none", name,
                  did_you_mean(name, {kConditionNames.begin(), kConditionNames.end()}),
                  fmt::join(kConditionNames, ", "));
    }
    conditions.insert(static_cast<Condition>(found - kConditionNames.begin()));
    if (comma == list.size()) return conditions;
    list.remove_prefix(comma + 1);
  }
}

}  // namespace seedframe
