// A YAML node that knows where it stands.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "config/diagnostics.h"

namespace seedframe {

/// One `--set path=value`: replaces or adds the value at a path of keys, such as
/// "variables.scene.parts" or "render.samples"; the value is YAML.
struct Override {
  std::string path;
  std::string value;
  /// Where it was written, when that was a config's `set`; empty for the command line.
  Place origin = {};
};

/// Splits "path=value"; without '=' or with an empty path it is a kInput error.
Result<Override> parse_override(const std::string& text);

class ConfigNode {
 public:
  /// Parses a YAML document and applies the overrides. A document with the key `base` is another
  /// config with some values replaced: that file is read (`base` starts at this file's folder), and
  /// what stands below `set` is applied as overrides. Errors: not YAML (with line and column),
  /// keys that stand twice, more than a million nodes (as alias bombs have), an override through a
  /// value that has no keys.
  static Result<ConfigNode> parse(const std::string& text, const std::string& file,
                                  const std::vector<Override>& overrides = {});

  bool is_map() const { return node_.IsMap(); }
  bool is_list() const { return node_.IsSequence(); }
  bool is_scalar() const { return node_.IsScalar(); }
  bool is_null() const { return node_.IsNull(); }
  /// "a mapping", "a list", "'text'", "nothing": what was found, for messages.
  std::string description() const;
  /// The text of a scalar.
  const std::string& text() const { return node_.Scalar(); }

  std::optional<ConfigNode> find(const std::string& key) const;
  /// In the order of the file.
  std::vector<std::pair<std::string, ConfigNode>> entries() const;
  std::vector<ConfigNode> items() const;

  Place place() const;
  const std::string& path() const { return path_; }
  /// The config's path as given, also for what comes from an override.
  const std::string& file() const { return source_->file; }

  /// Says of every key that is not among `known` that it is unknown, with "did you mean".
  void refuse_unknown_keys(const std::vector<std::string>& known, Diagnostics& errors) const;

 private:
  static Result<ConfigNode> parse(const std::string& text, const std::string& file,
                                  std::vector<Override> overrides, int bases);
  struct Source {
    std::string file;
    std::vector<Override> overrides;
  };
  ConfigNode(const YAML::Node& node, std::string path, std::shared_ptr<const Source> source)
      : node_(node), path_(std::move(path)), source_(std::move(source)) {}
  ConfigNode child(const YAML::Node& node, std::string path) const {
    return {node, std::move(path), source_};
  }

  YAML::Node node_;
  std::string path_;
  std::shared_ptr<const Source> source_;
};

}  // namespace seedframe
