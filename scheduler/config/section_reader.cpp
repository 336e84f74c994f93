#include "config/section_reader.h"

#include <cctype>

#include "base/nearest_name.h"

namespace seedframe {

SectionReader::SectionReader(const ConfigNode& node, Diagnostics& errors)
    : node_(node), errors_(errors) {
  if (!node.is_map() && !node.is_null()) {
    errors_.add(node.place(), "expected a mapping, found " + node.description());
  }
}

std::optional<ConfigNode> SectionReader::find(const std::string& key) {
  known_.push_back(key);
  return node_.find(key);
}

std::optional<ConfigNode> SectionReader::require(const std::string& key) {
  auto found = find(key);
  if (!found) errors_.add(node_.place(), "the key '" + key + "' is missing");
  return found;
}

NumberSource SectionReader::number(const std::string& key, double fallback) {
  const auto found = find(key);
  return found ? read_number(*found, errors_) : number_constant(fallback);
}

std::optional<NumberSource> SectionReader::optional_number(const std::string& key) {
  const auto found = find(key);
  return found ? std::optional(read_number(*found, errors_)) : std::nullopt;
}

std::optional<GridConfig> SectionReader::grid() {
  const auto node = find("grid");
  if (!node) return std::nullopt;
  GridConfig grid;
  grid.place = node->place();
  SectionReader section(*node, errors_);
  const auto counts = section.require("counts");
  const std::vector<ConfigNode> items = counts ? counts->items() : std::vector<ConfigNode>();
  if (counts && (items.empty() || items.size() > 3)) {
    errors_.add(counts->place(),
                "expected [along x, along y, along z], found " + counts->description());
  }
  for (std::size_t i = 0; i < 3; ++i) {
    grid.counts[i] = i < items.size() ? read_number(items[i], errors_) : number_constant(1.0);
  }
  grid.spacing_m = section.vector("spacing_m", {1, 1, 1});
  section.refuse_other_keys();
  return grid;
}

MaterialSource SectionReader::material(const std::string& key) {
  const auto found = find(key);
  if (found) return read_material_source(*found, errors_);
  return NameSource{node_.place(), {{"default", number_constant(1.0)}}};
}

VectorSource SectionReader::vector(const std::string& key, const std::array<double, 3>& fallback) {
  if (const auto found = find(key)) return read_vector(*found, errors_);
  VectorSource source;
  for (std::size_t i = 0; i < 3; ++i) source.components[i] = number_constant(fallback[i]);
  return source;
}

ColorSource SectionReader::color(const std::string& key, const std::array<double, 3>& fallback) {
  if (const auto found = find(key)) return read_color(*found, errors_);
  ColorSource source;
  for (std::size_t i = 0; i < 3; ++i) source.components[i] = number_constant(fallback[i]);
  return source;
}

std::string SectionReader::text(const std::string& key, const std::string& fallback) {
  const auto found = find(key);
  if (!found) return fallback;
  if (!found->is_scalar() || found->text().empty()) {
    errors_.add(found->place(), "expected a text, found " + found->description());
    return fallback;
  }
  return found->text();
}

double SectionReader::constant(const std::string& key, double fallback) {
  const auto found = find(key);
  return found ? read_constant(*found, errors_) : fallback;
}

double SectionReader::positive(const std::string& key, double fallback) {
  const auto found = find(key);
  if (!found) return fallback;
  const std::size_t errors_before = errors_.size();
  const double value = read_constant(*found, errors_);
  if (value > 0.0 || errors_.size() > errors_before) return value;
  errors_.add(found->place(), "expected a number above 0, found " + found->description());
  return fallback;
}

long long SectionReader::integer(const std::string& key, long long fallback, long long least,
                                 long long most) {
  const auto found = find(key);
  return found ? read_integer(*found, least, most, errors_) : fallback;
}

bool SectionReader::flag(const std::string& key, bool fallback) {
  const auto found = find(key);
  return found ? read_flag(*found, errors_) : fallback;
}

Level SectionReader::redraw(Level fallback) {
  const auto found = find("redraw");
  if (!found) return fallback;
  const std::string text = found->is_scalar() ? found->text() : "";
  if (text == "scene") return Level::kScene;
  if (text == "frame") return Level::kFrame;
  if (text == "campaign") return Level::kCampaign;
  errors_.add(found->place(), "expected scene, frame or campaign, found " + found->description() +
                                  did_you_mean(text, {"scene", "frame", "campaign"}));
  return fallback;
}

std::vector<VariableConfig> SectionReader::variables(const std::string& key) {
  const auto found = find(key);
  return found ? read_variables(*found, errors_) : std::vector<VariableConfig>();
}

std::vector<std::string> SectionReader::texts(const std::string& key) {
  std::vector<std::string> list;
  const auto found = find(key);
  if (!found) return list;
  if (!found->is_list()) {
    errors_.add(found->place(), "expected a list of texts, found " + found->description());
  }
  for (const ConfigNode& item : found->items()) {
    if (item.is_scalar() && !item.text().empty()) {
      list.push_back(item.text());
    } else {
      errors_.add(item.place(), "expected a text, found " + item.description());
    }
  }
  return list;
}

void SectionReader::refuse_other_keys() { node_.refuse_unknown_keys(known_, errors_); }

bool is_identifier(const std::string& name) {
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0) return false;
  for (const char c : name) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!plain) return false;
  }
  return true;
}

bool check_entry_count(const ConfigNode& node, Diagnostics& errors) {
  constexpr std::size_t kMost = 10'000;
  const std::size_t count = node.entries().size();
  if (count <= kMost) return true;
  errors.add(node.place(), fmt::format("at most {} names are possible, found {}", kMost, count));
  return false;
}

MaterialSource read_material_source(const ConfigNode& node, Diagnostics& errors) {
  if (!node.find("realistic_share")) return read_name(node, errors);
  MaterialShareConfig share;
  share.place = node.place();
  SectionReader section(node, errors);
  share.realistic_share = section.number("realistic_share", 0.0);
  if (section.find("realistic")) share.realistic = section.texts("realistic");
  if (section.find("parametric")) share.parametric = section.texts("parametric");
  section.refuse_other_keys();
  return share;
}

std::vector<VariableConfig> read_variables(const ConfigNode& node, Diagnostics& errors) {
  std::vector<VariableConfig> variables;
  if (!node.is_map() && !node.is_null()) {
    errors.add(node.place(), "expected a mapping of variables, found " + node.description());
  }
  if (!check_entry_count(node, errors)) return variables;
  for (const auto& [name, value] : node.entries()) {
    if (!is_identifier(name)) {
      errors.add(value.place(),
                 "a variable's name must be letters, digits and '_', and not start with a digit");
      continue;
    }
    VariableConfig variable{name, value.place(), NumberSource{}};
    if (is_name_choice(value)) {
      variable.source = read_name(value, errors);
    } else if (value.is_list()) {
      variable.source = read_vector(value, errors);
    } else if (is_color_mapping(value)) {
      variable.source = read_color(value, errors);
    } else {
      variable.source = read_number(value, errors);
    }
    variables.push_back(std::move(variable));
  }
  return variables;
}

}  // namespace seedframe
