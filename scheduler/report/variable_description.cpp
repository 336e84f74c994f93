#include "report/variable_description.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace seedframe {
namespace {

const char* level_name(Level level) {
  constexpr std::array kLevels = {"campaign", "scene", "frame"};
  return kLevels[static_cast<std::size_t>(level)];
}

std::vector<const char*> parameter_names(DistributionKind kind) {
  switch (kind) {
    case DistributionKind::kUniform:
    case DistributionKind::kLogUniform:
    case DistributionKind::kInteger:
      return {"min", "max"};
    case DistributionKind::kNormal:
      return {"mean", "std"};
    case DistributionKind::kTruncatedNormal:
    case DistributionKind::kBoundedNormal:
      return {"mean", "std", "min", "max"};
    case DistributionKind::kPoisson:
      return {"mean"};
    case DistributionKind::kChoice:
    case DistributionKind::kEmpirical:
      break;
  }
  return {};
}

Json json_of(const DrawLaw& law) {
  Json json = {{"kind", name_of(law.kind)}, {"level", level_name(law.level)}};
  const std::vector<const char*> names = parameter_names(law.kind);
  for (std::size_t i = 0; i < names.size(); ++i) json[names[i]] = law.parameters[i];
  if (law.kind == DistributionKind::kChoice) {
    const bool closed = !law.names.empty() || !law.numbers.empty();
    if (closed) json["values"] = law.names.empty() ? Json(law.numbers) : Json(law.names);
    json["weights"] = law.weights;
  }
  if (law.samples != nullptr) json["samples"] = law.samples->size();
  return json;
}

/// Null where either end is open.
Json range_of(const DrawLaw& law) {
  if (law.kind == DistributionKind::kEmpirical && law.samples && !law.samples->empty()) {
    return {law.samples->front(), law.samples->back()};
  }
  if (law.kind == DistributionKind::kChoice && !law.numbers.empty()) {
    const auto [least, most] = std::minmax_element(law.numbers.begin(), law.numbers.end());
    return {*least, *most};
  }
  const std::vector<const char*> names = parameter_names(law.kind);
  if (names.empty() || names.back() != std::string_view("max")) return {};
  return {law.parameters[names.size() - 2], law.parameters[names.size() - 1]};
}

struct DrawnFrom {
  Json laws = Json::array({nullptr, nullptr, nullptr});
  Json ranges = Json::array({nullptr, nullptr, nullptr});
};

/// What graphs call the variable that a draw is of, with the component; "variables.scene.turn" is
/// "turn", "objects.bolts.variables.spin[2]/3" the third of "objects.bolts.spin". Of the first
/// copy.
std::pair<std::string, std::size_t> variable_of(std::string draw) {
  constexpr std::string_view kWord = "variables.";
  const std::size_t at = draw.rfind(kWord);
  if (at == std::string::npos) return {};
  if (const std::size_t copy = draw.find('/', at); copy != std::string::npos) {
    if (draw.substr(copy) != "/0") return {};
    draw.erase(copy);
  }
  std::size_t component = 0;
  if (const std::size_t bracket = draw.find('[', at); bracket != std::string::npos) {
    component = static_cast<std::size_t>(draw[bracket + 1] - '0');
    draw.erase(bracket);
  }
  std::string name = draw.substr(at + kWord.size());
  // Of the campaign the level stands before the name.
  if (at == 0) return {name.substr(name.find('.') + 1), component};
  return {draw.substr(0, at) + name, component};
}

}  // namespace

Result<Json> describe_variables(const SceneExpander& expander) {
  const Result<ExpandedFrame> frame =
      expander.expand(0, {.id = false, .draws = true, .graph = true});
  if (!frame) return forward_error(frame);
  std::map<std::string, DrawnFrom> drawn;
  for (const Draw& draw : frame->draws) {
    const auto [name, component] = variable_of(draw.name);
    if (name.empty() || !draw.law || component > 2) continue;
    drawn[name].laws[component] = json_of(*draw.law);
    drawn[name].ranges[component] = range_of(*draw.law);
  }
  Json variables = Json::object();
  for (const auto& [name, variable] : expander.variables()) {
    const bool is_vector = variable.type.type == ValueType::kVector;
    const char* type = variable.type.type == ValueType::kText ? "name"
                       : is_vector                            ? "vector"
                                                              : "number";
    const Dimension& dimension = variable.type.dimension;
    Json& json = variables[name];
    json = {{"type", type},
            {"unit", dimension.is_plain() ? Json() : Json(dimension.text())},
            {"per_copy", variable.per_copy},
            {"value", frame->graph.value(name, Json())},
            {"distribution", nullptr},
            {"range", nullptr}};
    const auto from = drawn.find(name);
    if (from == drawn.end()) continue;
    json["distribution"] = is_vector ? from->second.laws : from->second.laws[0];
    json["range"] = is_vector ? from->second.ranges : from->second.ranges[0];
  }
  return variables;
}

}  // namespace seedframe
