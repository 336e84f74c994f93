#include "image/color_config_level.h"

#include <array>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace seedframe {
namespace OCIO = OCIO_NAMESPACE;
namespace {

using Level = std::pair<int, int>;
using NameSet = std::set<std::string>;

constexpr const char* kLevel = "ocio_profile_version";
constexpr Level kOfLibrary = {OCIO_VERSION_MAJOR, OCIO_VERSION_MINOR};

/// Of a config's text, which need not be parsed for it: "ocio_profile_version: 2.4", or just 2.
Level level_of(const std::string& config) {
  Level level = {1, 0};
  std::istringstream lines(config);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(kLevel)) continue;
    std::istringstream text(line.substr(line.find(':') + 1));
    char point = '.';
    text >> level.first >> point >> level.second;
    break;
  }
  return level;
}

NameSet built_in_styles() {
  NameSet styles;
  const auto registry = OCIO::BuiltinTransformRegistry::Get();
  for (std::size_t i = 0; i < registry->getNumBuiltins(); ++i) {
    styles.insert(registry->getBuiltinStyle(i));
  }
  return styles;
}

/// Takes out of a config what this library cannot make, and then what is made of that.
class Lowering {
 public:
  explicit Lowering(const YAML::Node& root) : root_(root), styles_(built_in_styles()) {}

  /// The names of the views that are gone.
  NameSet run() {
    while (drop_entries()) {
    }
    return drop_views();
  }

 private:
  bool is_gone(const YAML::Node& name) const {
    return name && name.IsScalar() && gone_.count(name.as<std::string>()) > 0;
  }

  /// Whether something in `node` is a transform that cannot be made.
  bool cannot_be_made(const YAML::Node& node) const {
    if (node.IsSequence()) {
      for (const YAML::Node& each : node) {
        if (cannot_be_made(each)) return true;
      }
    }
    if (!node.IsMap()) return false;
    const YAML::Node style = node["style"];
    if (node.Tag() == "!<BuiltinTransform>" || node.Tag() == "BuiltinTransform") {
      return !style || styles_.count(style.as<std::string>()) == 0;
    }
    for (const char* space : {"src", "dst", "view", "looks", "name_transform"}) {
      if (is_gone(node[space])) return true;
    }
    for (const auto& member : node) {
      if (cannot_be_made(member.second)) return true;
    }
    return false;
  }

  void note_as_gone(const YAML::Node& entry) {
    gone_.insert(entry["name"].as<std::string>());
    for (const YAML::Node& alias : entry["aliases"]) gone_.insert(alias.as<std::string>());
  }

  /// Whether any entry went.
  bool drop_entries() {
    constexpr std::array<const char*, 5> kLists = {"colorspaces", "display_colorspaces",
                                                   "view_transforms", "looks", "named_transforms"};
    bool some = false;
    for (const char* list : kLists) {
      if (!root_[list] || !root_[list].IsSequence()) continue;
      YAML::Node kept(YAML::NodeType::Sequence);
      for (const YAML::Node& entry : root_[list]) {
        if (cannot_be_made(entry) || is_gone(entry["process_space"])) {
          note_as_gone(entry);
          some = true;
        } else {
          kept.push_back(entry);
        }
      }
      root_[list] = kept;
    }
    return some;
  }

  bool is_of_what_is_gone(const YAML::Node& view) const {
    return is_gone(view["view_transform"]) || is_gone(view["colorspace"]) ||
           is_gone(view["display_colorspace"]) || is_gone(view["looks"]);
  }

  /// The names of those that no display has any more.
  NameSet drop_views() {
    NameSet gone, kept, empty_displays;
    YAML::Node displays(YAML::NodeType::Map);
    for (const auto& display : root_["displays"]) {
      YAML::Node views(YAML::NodeType::Sequence);
      for (const YAML::Node& view : display.second) {
        const bool drop = is_of_what_is_gone(view);
        (drop ? gone : kept).insert(view["name"].as<std::string>());
        if (!drop) views.push_back(view);
      }
      const std::string name = display.first.as<std::string>();
      if (views.size() > 0) displays[name] = views;
      if (views.size() == 0) empty_displays.insert(name);
    }
    root_["displays"] = displays;
    for (const std::string& name : kept) gone.erase(name);
    drop_from_list("active_views", gone);
    drop_from_list("active_displays", empty_displays);
    return gone;
  }

  void drop_from_list(const char* list, const NameSet& names) {
    if (!root_[list] || !root_[list].IsSequence()) return;
    YAML::Node kept(YAML::NodeType::Sequence);
    for (const YAML::Node& each : root_[list]) {
      if (names.count(each.as<std::string>()) == 0) kept.push_back(each);
    }
    root_[list] = kept;
  }

  YAML::Node root_;
  NameSet styles_;
  NameSet gone_;  ///< names and aliases of what was dropped
};

}  // namespace

std::string lower_color_config(const std::string& text, std::set<std::string>& left_out) {
  if (level_of(text) <= kOfLibrary) return text;
  YAML::Node root = YAML::Load(text);
  root[kLevel] = fmt::format("{}.{}", kOfLibrary.first, kOfLibrary.second);
  left_out = Lowering(root).run();
  YAML::Emitter emitter;
  emitter << root;
  return emitter.c_str();
}

ReadColorConfig read_color_config(const std::string& text, const std::filesystem::path& folder) {
  ReadColorConfig read;
  std::istringstream stream(lower_color_config(text, read.left_out));
  read.config = OCIO::Config::CreateFromStream(stream)->createEditableCopy();
  read.config->setWorkingDir(folder.c_str());
  return read;
}

}  // namespace seedframe
