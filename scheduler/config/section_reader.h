// Reads one mapping of a config key by key, and in the end refuses the keys that were not asked
// for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/campaign_config.h"
#include "config/values.h"

namespace seedframe {

class SectionReader {
 public:
  /// A node that is not a mapping is an error, and then every key is absent.
  SectionReader(const ConfigNode& node, Diagnostics& errors);

  /// The node below a key, or none; from then on the key is known.
  std::optional<ConfigNode> find(const std::string& key);
  /// The same, and an error when it is absent.
  std::optional<ConfigNode> require(const std::string& key);

  NumberSource number(const std::string& key, double fallback);
  std::optional<NumberSource> optional_number(const std::string& key);
  VectorSource vector(const std::string& key, const std::array<double, 3>& fallback);
  ColorSource color(const std::string& key, const std::array<double, 3>& fallback);
  std::string text(const std::string& key, const std::string& fallback);
  double constant(const std::string& key, double fallback);
  long long integer(const std::string& key, long long fallback, long long least, long long most);
  bool flag(const std::string& key, bool fallback);
  /// A number above zero that cannot vary.
  double positive(const std::string& key, double fallback);
  Level redraw(Level fallback);
  /// The key `grid`.
  std::optional<GridConfig> grid();
  /// A name, or a share of the library; absent: the material "default".
  MaterialSource material(const std::string& key);
  std::vector<VariableConfig> variables(const std::string& key);
  std::vector<std::string> texts(const std::string& key);

  void refuse_other_keys();
  Diagnostics& errors() { return errors_; }
  const ConfigNode& node() const { return node_; }

 private:
  ConfigNode node_;
  Diagnostics& errors_;
  std::vector<std::string> known_;
};

/// Reads name: {…} pairs; a name that is not letters, digits and '_' is an error, for formulas use
/// it.
std::vector<VariableConfig> read_variables(const ConfigNode& node, Diagnostics& errors);
bool is_identifier(const std::string& name);

/// More than 10,000 entries are an error, and false: each may take kilobytes, and variables that
/// need each other are followed one within the other.
bool check_entry_count(const ConfigNode& node, Diagnostics& errors);

MaterialSource read_material_source(const ConfigNode& node, Diagnostics& errors);

/// The mapping below a key, whose keys are identifiers of the user's choice, in the file's order.
template <class T>
std::vector<T> read_named(SectionReader& section, const char* key,
                          T (*read)(const std::string&, const ConfigNode&, Diagnostics&)) {
  std::vector<T> list;
  const auto node = section.find(key);
  if (!node) return list;
  if (!node->is_map() && !node->is_null()) {
    section.errors().add(node->place(),
                         "expected a mapping of names, found " + node->description());
  }
  if (!check_entry_count(*node, section.errors())) return list;
  for (const auto& [name, body] : node->entries()) {
    if (!is_identifier(name)) {
      section.errors().add(body.place(),
                           "a name must be letters, digits and '_', and not start with a digit");
    }
    list.push_back(read(name, body, section.errors()));
  }
  return list;
}

}  // namespace seedframe
