#include "config/config_node.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <span>
#include <string_view>

#include "base/files.h"
#include "base/nearest_name.h"
#include "config/config_text.h"
#include "config/yaml_document.h"
#include "config/yaml_size.h"

namespace seedframe {
namespace {

std::string join_path(const std::string& parent, const std::string& key) {
  return parent.empty() ? key : parent + "." + key;
}

Place yaml_place(const std::string& file, const YAML::Mark& mark, const std::string& path) {
  return {file, mark.is_null() ? 0 : mark.line + 1, mark.is_null() ? 0 : mark.column + 1, path};
}

// Of "objects.robots.slots.shell.realistic_share"; every value keeps the path to it.
constexpr std::size_t kLongestPath = 500;

// Aliases make a small file walk like a huge one; every reader of the tree is safe below these
// bounds.
class TreeCheck {
 public:
  TreeCheck(const std::string& file, Diagnostics& errors) : file_(file), errors_(errors) {}

  void walk(const YAML::Node& node, const std::string& path, int depth) {
    bytes_ += path.size() + (node.IsScalar() ? node.Scalar().size() : 0);
    if (++nodes_ > kMostYamlNodes || depth > kDeepestYaml || bytes_ > kMostYamlBytes ||
        path.size() > kLongestPath) {
      if (!bomb_) {
        errors_.add(yaml_place(file_, node.Mark(), ""),
                    fmt::format("the config has more than {} values, {} levels or {} bytes of text "
                                "(aliases counted each time they are used), or the path of a key "
                                "has more than {} characters",
                                kMostYamlNodes, kDeepestYaml, kMostYamlBytes, kLongestPath));
      }
      bomb_ = true;
    }
    if (bomb_) return;
    if (node.IsMap()) {
      std::set<std::string> seen;
      for (const auto& entry : node) {
        if (!entry.first.IsScalar()) {
          errors_.add(yaml_place(file_, entry.first.Mark(), path), "a key must be a plain name");
          continue;
        }
        const std::string& key = entry.first.Scalar();
        if (!seen.insert(key).second) {
          errors_.add(yaml_place(file_, entry.first.Mark(), join_path(path, key)),
                      "this key is given twice in the same mapping");
        }
        walk(entry.second, join_path(path, key), depth + 1);
      }
    } else if (node.IsSequence()) {
      std::size_t index = 0;
      for (const auto& item : node) walk(item, fmt::format("{}[{}]", path, index++), depth + 1);
    }
  }

 private:
  const std::string& file_;
  Diagnostics& errors_;
  int nodes_ = 0;
  std::size_t bytes_ = 0;
  bool bomb_ = false;
};

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> keys;
  std::size_t start = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', start)) {
    keys.push_back(path.substr(start, dot - start));
    start = dot + 1;
  }
  keys.push_back(path.substr(start));
  return keys;
}

std::string origin_of(const Override& change) {
  return change.origin.line > 0 ? change.origin.text()
                                : "--set " + change.path + "=" + change.value;
}

Status apply(const YAML::Node& root, const Override& change) {
  const std::string where = origin_of(change);
  Result<YAML::Node> value = read_yaml_document(change.value, where);
  if (!value) return forward_error(value);
  const std::vector<std::string> keys = split_path(change.path);
  YAML::Node node = root;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].empty()) return fail(ErrorKind::kInput, "{}: the path has an empty key", where);
    if (!node.IsMap() && !node.IsNull()) {
      return fail(ErrorKind::kInput, "{}: there is nothing to set below '{}': it is not a mapping",
                  where, i == 0 ? "the config" : keys[i - 1]);
    }
    if (i + 1 == keys.size()) {
      if (value->IsNull()) {
        node.remove(keys[i]);
      } else {
        node[keys[i]] = *value;
      }
    } else {
      YAML::Node next = node[keys[i]];
      if (!next.IsDefined() || next.IsNull()) {
        node[keys[i]] = YAML::Node(YAML::NodeType::Map);
        next = node[keys[i]];
      }
      node.reset(next);
    }
  }
  return {};
}

/// What a sweep goes through becomes campaign variables with its first values.
void make_variables_of_sweep(YAML::Node root) {
  YAML::Node variables = root["variables"];
  if (!variables.IsDefined() || variables.IsNull()) {
    root["variables"] = YAML::Node(YAML::NodeType::Map);
    variables.reset(root["variables"]);
  }
  if (!variables.IsMap()) return;
  YAML::Node campaign = variables["campaign"];
  if (!campaign.IsDefined() || campaign.IsNull()) {
    variables["campaign"] = YAML::Node(YAML::NodeType::Map);
    campaign.reset(variables["campaign"]);
  }
  if (!campaign.IsMap()) return;
  const auto add = [&](const std::string& name, const YAML::Node& value) {
    if (!value.IsScalar() || campaign[name].IsDefined()) return;
    if (parse_double(value.Scalar())) {
      campaign[name] = value;
    } else {
      campaign[name]["choice"].push_back(value);  // a plain text would be a formula
    }
  };
  for (const auto& axis : root["sweep"]["values"]) {
    if (!axis.second.IsSequence() || axis.second.size() == 0) continue;
    const YAML::Node first = axis.second[0];
    if (!first.IsMap()) add(axis.first.Scalar(), first);
    if (!first.IsMap()) continue;
    for (const auto& entry : first) add(entry.first.Scalar(), entry.second);
  }
}

/// Each line of graphs is a scene of one frame, so they come in place of what says how many there
/// are; `before` are the overrides that came before, of which those of the same file, or of the
/// command line too, may say otherwise of the frames.
void make_way_for_graphs(YAML::Node root, const Override& graphs,
                         std::span<const Override> before) {
  const YAML::Node sweep = root["sweep"];
  if (sweep.IsDefined() && sweep.IsMap() && sweep["values"].IsDefined() &&
      sweep["values"].IsMap()) {
    make_variables_of_sweep(root);
  }
  root.remove("scenes");
  root.remove("sweep");
  const bool frames_are_meant =
      std::any_of(before.begin(), before.end(), [&](const Override& change) {
        return change.path == "frames_per_scene" && change.origin.file == graphs.origin.file;
      });
  if (!frames_are_meant) root.remove("frames_per_scene");
}

constexpr int kMostBases = 8;
constexpr std::size_t kMostOverrides = 1000;  // every value asks all of them where it comes from

/// The config that `root`'s key `base` names, and in `overrides`, before what is there already,
/// what `root` replaces in it.
Result<std::string> read_base(const YAML::Node& root, const std::string& file,
                              const AllowedFolders& allowed, std::filesystem::path& base_file,
                              std::vector<Override>& overrides) {
  const auto fault = [&](const YAML::Node& node, const std::string& key,
                         const std::string& message) {
    return fail(ErrorKind::kInput, "{}: {}", yaml_place(file, node.Mark(), key).text(), message);
  };
  std::vector<Override> own;
  const auto replace = [&](const std::string& path, const YAML::Node& value) {
    own.push_back({path, YAML::Dump(value), yaml_place(file, value.Mark(), path)});
  };
  for (const auto& entry : root) {
    const std::string& key = entry.first.Scalar();
    if (key == "seedframe" || key == "name" || key == "description") {
      replace(key, entry.second);
    } else if (key == "set" && entry.second.IsMap()) {
      for (const auto& change : entry.second) replace(change.first.Scalar(), change.second);
    } else if (key != "base") {
      return fault(
          entry.second, key,
          "a config with a base has only seedframe, base, name, description and set, which "
          "is a mapping of path: value");
    }
  }
  const YAML::Node base = root["base"];
  if (!base.IsScalar()) return fault(base, "base", "expected the path of a config");
  base_file = std::filesystem::path(file).parent_path() / base.Scalar();
  if (Status inside = allowed.check(base_file, "'" + base.Scalar() + "'"); !inside) {
    return fault(base, "base", inside.error().message);
  }
  std::error_code missing;
  if (!std::filesystem::is_regular_file(base_file, missing)) {
    return fault(
        base, "base",
        "there is no config " + base_file.string() + " (paths start at the config's folder)");
  }
  Result<std::string> text = read_file(base_file, kLargestConfig);
  if (!text) return fault(base, "base", text.error().message);
  if (own.size() + overrides.size() > kMostOverrides) {
    return fault(base, "set", fmt::format("at most {} values can be replaced", kMostOverrides));
  }
  overrides.insert(overrides.begin(), own.begin(), own.end());
  return text;
}

}  // namespace

Result<Override> parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return fail(ErrorKind::kInput, "--set {}: expected path=value, such as render.samples=16",
                text);
  }
  return Override{text.substr(0, equals), text.substr(equals + 1)};
}

Result<ConfigNode> ConfigNode::parse(const std::string& text, const std::string& file,
                                     std::vector<Override> overrides, AllowedFolders allowed) {
  std::filesystem::path folder = std::filesystem::path(file).parent_path();
  allowed.add(folder);
  return parse(text,
               {file, std::move(overrides), std::move(folder), std::move(allowed),
                std::make_shared<std::vector<std::filesystem::path>>()},
               0);
}

Result<ConfigNode> ConfigNode::parse(const std::string& text, Source source, int bases) {
  const std::string& file = source.file;
  Result<YAML::Node> root = read_yaml_document(text, file);
  if (!root) return forward_error(root);
  Diagnostics errors;
  TreeCheck(file, errors).walk(*root, "", 0);
  if (!errors.empty()) return tl::unexpected(errors.as_error());
  if (root->IsMap() && (*root)["base"].IsDefined()) {
    if (bases == kMostBases) {
      return fail(ErrorKind::kInput, "{}: more than {} configs in a chain of 'base'", file,
                  kMostBases);
    }
    std::filesystem::path base_file;
    const Result<std::string> base =
        read_base(*root, file, source.allowed, base_file, source.overrides);
    if (!base) return forward_error(base);
    source.file = base_file.string();
    source.named->push_back(base_file);
    return parse(*base, std::move(source), bases + 1);
  }
  try {
    for (std::size_t i = 0; i < source.overrides.size(); ++i) {
      const Override& change = source.overrides[i];
      if (Status applied = apply(*root, change); !applied) return forward_error(applied);
      if (change.path == "graphs" && (*root)["graphs"].IsDefined()) {
        make_way_for_graphs(*root, change, std::span(source.overrides).first(i));
      }
    }
  } catch (const YAML::Exception& error) {
    return fail(ErrorKind::kInput, "{}: an override does not fit: {}", file, error.what());
  }
  TreeCheck(file, errors).walk(*root, "", 0);
  if (!errors.empty()) return tl::unexpected(errors.as_error());
  return ConfigNode(*root, "", std::make_shared<const Source>(std::move(source)));
}

std::string ConfigNode::description() const {
  switch (node_.Type()) {
    case YAML::NodeType::Map:
      return "a mapping";
    case YAML::NodeType::Sequence:
      return fmt::format("a list of {}", node_.size());
    case YAML::NodeType::Scalar:
      return "'" + node_.Scalar() + "'";
    default:
      return "nothing";
  }
}

std::optional<ConfigNode> ConfigNode::find(const std::string& key) const {
  if (!node_.IsMap()) return std::nullopt;
  for (const auto& entry : node_) {
    if (entry.first.Scalar() == key) return child(entry.second, join_path(path_, key));
  }
  return std::nullopt;
}

std::vector<std::pair<std::string, ConfigNode>> ConfigNode::entries() const {
  std::vector<std::pair<std::string, ConfigNode>> list;
  if (!node_.IsMap()) return list;
  for (const auto& entry : node_) {
    list.emplace_back(entry.first.Scalar(),
                      child(entry.second, join_path(path_, entry.first.Scalar())));
  }
  return list;
}

std::vector<ConfigNode> ConfigNode::items() const {
  std::vector<ConfigNode> list;
  if (!node_.IsSequence()) return list;
  for (const auto& item : node_) {
    list.push_back(child(item, fmt::format("{}[{}]", path_, list.size())));
  }
  return list;
}

Place ConfigNode::place() const {
  // The last one that set it counts.
  for (auto it = source_->overrides.rbegin(); it != source_->overrides.rend(); ++it) {
    const Override& change = *it;
    const bool inside = path_ == change.path || path_.starts_with(change.path + ".") ||
                        path_.starts_with(change.path + "[");
    if (!inside) continue;
    if (change.origin.line == 0) return {origin_of(change), 0, 0, path_};
    Place place = change.origin;
    place.path = path_;
    return place;
  }
  return yaml_place(source_->file, node_.Mark(), path_);
}

std::optional<std::filesystem::path> ConfigNode::named_path(Diagnostics& errors) const {
  if (!is_scalar() || text().empty()) {
    errors.add(place(), "expected a path, found " + description());
    return std::nullopt;
  }
  std::filesystem::path path = source_->folder / text();
  const Status inside = source_->allowed.check(path, "'" + text() + "'");
  source_->named->push_back(path);
  if (inside) return path;
  errors.add(place(), inside.error().message);
  return std::nullopt;
}

void ConfigNode::refuse_unknown_keys(const std::vector<std::string>& known,
                                     Diagnostics& errors) const {
  for (const auto& [key, node] : entries()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      errors.add(node.place(), "unknown key" + did_you_mean(key, known));
    }
  }
}

}  // namespace seedframe
