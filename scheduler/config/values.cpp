#include "config/values.h"

#include <charconv>
#include <cmath>

#include "base/nearest_name.h"
#include "config/config_text.h"
#include "config/csv_column.h"

namespace seedframe {
namespace {

struct DistributionSyntax {
  const char* name;
  DistributionKind kind;
  std::vector<std::string> parameters;
};

const std::vector<DistributionSyntax>& distributions() {
  static const std::vector<DistributionSyntax> list = {
      {"uniform", DistributionKind::kUniform, {"min", "max"}},
      {"normal", DistributionKind::kNormal, {"mean", "std"}},
      {"truncated_normal", DistributionKind::kTruncatedNormal, {"mean", "std", "min", "max"}},
      {"bounded_normal", DistributionKind::kBoundedNormal, {"mean", "std", "min", "max"}},
      {"log_uniform", DistributionKind::kLogUniform, {"min", "max"}},
      {"integer", DistributionKind::kInteger, {"min", "max"}},
      {"poisson", DistributionKind::kPoisson, {"mean"}},
  };
  return list;
}

std::vector<std::string> distribution_names() {
  std::vector<std::string> names = {"constant", "choice", "mixture", "empirical", "sobol"};
  for (const DistributionSyntax& syntax : distributions()) names.emplace_back(syntax.name);
  return names;
}

// YAML writes these for what has no place in a scene.
bool is_yaml_non_finite(const std::string& text) {
  static const std::vector<std::string> spellings = {".nan", ".NaN", ".NAN",  ".inf",
                                                     ".Inf", ".INF", "-.inf", "+.inf"};
  for (const std::string& spelling : spellings) {
    if (text == spelling) return true;
  }
  return false;
}

std::string join(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

std::vector<NumberSource> read_parameters(const ConfigNode& node, const DistributionSyntax& syntax,
                                          Diagnostics& errors) {
  std::vector<NumberSource> parameters;
  if (node.is_scalar() && syntax.parameters.size() == 1) return {read_number(node, errors)};
  if (node.is_list() && node.items().size() == syntax.parameters.size()) {
    for (const ConfigNode& item : node.items()) parameters.push_back(read_number(item, errors));
    return parameters;
  }
  if (!node.is_map()) {
    errors.add(node.place(), fmt::format("{} needs [{}], found {}", syntax.name,
                                         join(syntax.parameters), node.description()));
    return std::vector<NumberSource>(syntax.parameters.size());
  }
  node.refuse_unknown_keys(syntax.parameters, errors);
  for (const std::string& name : syntax.parameters) {
    const auto found = node.find(name);
    if (!found) errors.add(node.place(), fmt::format("{} needs '{}'", syntax.name, name));
    parameters.push_back(found ? read_number(*found, errors) : NumberSource{});
  }
  return parameters;
}

struct ChoiceOption {
  ConfigNode value;
  NumberSource weight;
};

// choice: [a, b], or [{value: a, weight: 2}, …]. The form {a: 2, b: 1} is read by its callers,
// for there the values are keys.
std::vector<ChoiceOption> read_choice_list(const ConfigNode& node, Diagnostics& errors) {
  std::vector<ChoiceOption> options;
  for (const ConfigNode& item : node.items()) {
    const auto value = item.find("value");
    if (!value) {
      options.push_back({item, number_constant(1.0)});
      continue;
    }
    item.refuse_unknown_keys({"value", "weight"}, errors);
    const auto weight = item.find("weight");
    options.push_back({*value, weight ? read_number(*weight, errors) : number_constant(1.0)});
  }
  if (options.empty()) {
    errors.add(node.place(), "choice needs a list of options or a mapping of option: weight");
  }
  return options;
}

NumberSource read_number_choice(const ConfigNode& node, Diagnostics& errors) {
  auto distribution = std::make_shared<Distribution>();
  distribution->kind = DistributionKind::kChoice;
  if (node.is_map()) {
    for (const auto& [key, weight] : node.entries()) {
      const auto value = parse_double(key);
      if (!value) errors.add(weight.place(), "this option is not a number");
      distribution->parameters.push_back(number_constant(value.value_or(0.0)));
      distribution->weights.push_back(read_number(weight, errors));
    }
  } else {
    for (ChoiceOption& option : read_choice_list(node, errors)) {
      distribution->parameters.push_back(read_number(option.value, errors));
      distribution->weights.push_back(std::move(option.weight));
    }
  }
  if (distribution->parameters.empty() && node.is_map()) {
    errors.add(node.place(), "choice has no options");
  }
  return {node.place(), distribution};
}

/// The nodes of [a, b] or {first: a, second: b}; an error and nothing for anything else.
std::optional<std::array<ConfigNode, 2>> read_pair(const ConfigNode& node, const char* what,
                                                   const std::array<std::string, 2>& keys,
                                                   Diagnostics& errors) {
  const std::vector<ConfigNode> items = node.items();
  if (items.size() == 2) return std::array<ConfigNode, 2>{items[0], items[1]};
  if (node.is_map()) node.refuse_unknown_keys({keys[0], keys[1]}, errors);
  const auto first = node.find(keys[0]);
  const auto second = node.find(keys[1]);
  if (first && second) return std::array<ConfigNode, 2>{*first, *second};
  errors.add(node.place(), fmt::format("{} needs [{}, {}], found {}", what, keys[0], keys[1],
                                       node.description()));
  return std::nullopt;
}

NumberSource read_empirical(const ConfigNode& node, Diagnostics& errors) {
  auto distribution = std::make_shared<Distribution>();
  distribution->kind = DistributionKind::kEmpirical;
  const auto parts = read_pair(node, "empirical", {"file", "column"}, errors);
  if (!parts) return {node.place(), 0.0};
  const auto& [file, column] = *parts;
  const auto path = file.named_path(errors);
  if (!path) return {node.place(), 0.0};
  if (!column.is_scalar() || column.text().empty()) {
    errors.add(column.place(), "expected a text, found " + column.description());
    return {node.place(), 0.0};
  }
  auto samples = read_csv_column(*path, column.text());
  if (!samples) {
    errors.add(file.place(), samples.error().message);
    return {node.place(), 0.0};
  }
  distribution->samples = std::make_shared<const std::vector<double>>(std::move(*samples));
  return {node.place(), distribution};
}

NumberSource read_sobol(const ConfigNode& node, Diagnostics& errors) {
  const auto parts = read_pair(node, "sobol", {"dimension", "of"}, errors);
  if (!parts) return {node.place(), 0.0};
  constexpr long long kDimensions = 1000;
  const long long dimension = read_integer((*parts)[0], 0, kDimensions - 1, errors);
  const NumberSource of = read_number((*parts)[1], errors);
  const auto* inner = std::get_if<std::shared_ptr<const Distribution>>(&of.value);
  if (inner == nullptr || (*inner)->sobol_dimension) {
    errors.add((*parts)[1].place(), "sobol needs a distribution, such as {uniform: [0, 1]}");
    return {node.place(), 0.0};
  }
  auto distribution = std::make_shared<Distribution>(**inner);
  distribution->sobol_dimension = static_cast<int>(dimension);
  return {node.place(), distribution};
}

NumberSource read_mixture(const ConfigNode& node, Diagnostics& errors) {
  if (node.is_list()) return read_number_choice(node, errors);
  errors.add(node.place(),
             "mixture needs a list of distributions or of {value: …, weight: …}, found " +
                 node.description());
  return {node.place(), 0.0};
}

NumberSource read_distribution(const ConfigNode& node, Diagnostics& errors) {
  const auto entries = node.entries();
  if (entries.size() != 1) {
    errors.add(node.place(),
               "expected a number, a formula or one distribution such as "
               "{uniform: [0, 1]}, found a mapping of " +
                   std::to_string(entries.size()) + " keys");
    return {node.place(), 0.0};
  }
  const auto& [name, body] = entries.front();
  if (name == "constant") return read_number(body, errors);
  if (name == "choice") return read_number_choice(body, errors);
  if (name == "mixture") return read_mixture(body, errors);
  if (name == "empirical") return read_empirical(body, errors);
  if (name == "sobol") return read_sobol(body, errors);
  for (const DistributionSyntax& syntax : distributions()) {
    if (name != syntax.name) continue;
    auto distribution = std::make_shared<Distribution>();
    distribution->kind = syntax.kind;
    distribution->parameters = read_parameters(body, syntax, errors);
    return {node.place(), distribution};
  }
  errors.add(body.place(),
             "unknown distribution '" + name + "'" + did_you_mean(name, distribution_names()));
  return {node.place(), 0.0};
}

}  // namespace

NumberSource number_constant(double value) { return {Place{}, value}; }

NumberSource read_number(const ConfigNode& node, Diagnostics& errors) {
  if (node.is_map()) return read_distribution(node, errors);
  if (!node.is_scalar() || node.text().empty()) {
    errors.add(node.place(),
               "expected a number, a formula or a distribution, found " + node.description());
    return {node.place(), 0.0};
  }
  if (is_yaml_non_finite(node.text())) {
    errors.add(node.place(), "a number must be finite, found " + node.description());
    return {node.place(), 0.0};
  }
  const auto value = parse_double(node.text());
  if (value && !std::isfinite(*value)) {
    errors.add(node.place(), "a number must be finite, found " + node.description());
    return {node.place(), 0.0};
  }
  if (value) return {node.place(), *value};
  return {node.place(), Formula{node.text()}};
}

namespace {

/// Of a text that stands for a vector; a plain number does not.
NumberSource read_vector_formula(const ConfigNode& node, Diagnostics& errors) {
  NumberSource source = read_number(node, errors);
  if (!std::holds_alternative<Formula>(source.value)) {
    errors.add(node.place(), "expected a vector, found " + node.description());
    source.value = Formula{"[0, 0, 0]"};
  }
  return source;
}

}  // namespace

VectorSource read_vector(const ConfigNode& node, Diagnostics& errors) {
  VectorSource vector;
  if (node.is_scalar() && !node.text().empty()) {
    vector.formula = read_vector_formula(node, errors);
    return vector;
  }
  const auto items = node.items();
  if (items.size() != 3) {
    errors.add(node.place(), "expected a list of three numbers [x, y, z] or a formula, found " +
                                 node.description());
    return vector;
  }
  for (std::size_t i = 0; i < 3; ++i) vector.components[i] = read_number(items[i], errors);
  return vector;
}

ColorSource read_color(const ConfigNode& node, Diagnostics& errors) {
  ColorSource color;
  if (node.is_map()) {
    node.refuse_unknown_keys({"hsv", "kelvin", "rgb"}, errors);
    if (node.entries().size() > 1) {
      errors.add(node.place(), "a colour is one of hsv, kelvin and rgb, not several");
    }
    if (const auto kelvin = node.find("kelvin")) {
      color.model = ColorModel::kKelvin;
      color.components[0] = read_number(*kelvin, errors);
      return color;
    }
    if (const auto hsv = node.find("hsv")) {
      color.model = ColorModel::kHsv;
      if (hsv->items().size() == 3) {
        color.components = read_vector(*hsv, errors).components;
      } else {
        errors.add(hsv->place(), "expected [hue, saturation, value], found " + hsv->description());
      }
      return color;
    }
    if (const auto rgb = node.find("rgb"); rgb && !rgb->is_map()) return read_color(*rgb, errors);
  }
  if (node.is_scalar() && !node.text().empty()) {
    color.model = ColorModel::kFormula;
    color.components[0] = read_vector_formula(node, errors);
    return color;
  }
  if (node.items().size() != 3) {
    errors.add(node.place(),
               "expected a colour: [r, g, b], {hsv: [h, s, v]}, {kelvin: t} or a formula, found " +
                   node.description());
    return color;
  }
  color.components = read_vector(node, errors).components;
  return color;
}

NameSource read_name(const ConfigNode& node, Diagnostics& errors) {
  NameSource source{node.place(), {}};
  if (node.is_scalar() && !node.text().empty()) {
    source.options.push_back({node.text(), number_constant(1.0)});
    return source;
  }
  const auto choice = node.find("choice");
  if (!choice || node.entries().size() != 1) {
    errors.add(node.place(), "expected a name or {choice: …}, found " + node.description());
    source.options.push_back({"", number_constant(1.0)});
    return source;
  }
  if (choice->is_map()) {
    for (const auto& [key, weight] : choice->entries()) {
      source.options.push_back({key, read_number(weight, errors)});
    }
  } else {
    for (ChoiceOption& option : read_choice_list(*choice, errors)) {
      if (!option.value.is_scalar()) {
        errors.add(option.value.place(), "expected a name, found " + option.value.description());
        continue;
      }
      source.options.push_back({option.value.text(), std::move(option.weight)});
    }
  }
  if (source.options.empty()) {
    if (choice->is_map()) errors.add(choice->place(), "choice has no options");
    source.options.push_back({"", number_constant(1.0)});
  }
  return source;
}

double read_constant(const ConfigNode& node, Diagnostics& errors) {
  const NumberSource number = read_number(node, errors);
  if (const double* value = std::get_if<double>(&number.value)) return *value;
  errors.add(node.place(), "this must be a plain number: it cannot vary within a campaign");
  return 0.0;
}

long long read_integer(const ConfigNode& node, long long least, long long most,
                       Diagnostics& errors) {
  const std::string& text = node.is_scalar() ? node.text() : std::string();
  long long value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool parsed = error == std::errc() && stop == text.data() + text.size() && !text.empty();
  if (!parsed || value < least || value > most) {
    errors.add(node.place(), fmt::format("expected a whole number from {} to {}, found {}", least,
                                         most, node.description()));
    return least;
  }
  return value;
}

bool read_flag(const ConfigNode& node, Diagnostics& errors) {
  if (node.is_scalar() && node.text() == "true") return true;
  if (!node.is_scalar() || node.text() != "false") {
    errors.add(node.place(), "expected true or false, found " + node.description());
  }
  return false;
}

bool is_color_mapping(const ConfigNode& node) {
  return node.find("hsv") || node.find("rgb") || node.find("kelvin");
}

bool is_name_choice(const ConfigNode& node) {
  if (node.is_scalar()) return node.text().find("${") != std::string::npos;
  const auto choice = node.find("choice");
  if (!choice) return false;
  if (choice->is_map()) {
    for (const auto& entry : choice->entries()) {
      if (parse_double(entry.first)) return false;
    }
    return true;
  }
  for (const ConfigNode& item : choice->items()) {
    const ConfigNode value = item.find("value").value_or(item);
    if (!value.is_scalar() || parse_double(value.text())) return false;
  }
  return !choice->items().empty();
}

}  // namespace seedframe
