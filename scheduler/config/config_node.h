// A YAML node that knows where it stands.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "base/allowed_folders.h"
#include "base/diagnostics.h"
#include "spec/campaign_source.h"

namespace seedframe {

/// Splits "path=value"; without '=' or with an empty path it is a kInput error.
Result<Override> parse_override(const std::string& text);

class ConfigNode {
 public:
  /// Parses a YAML document and applies the overrides. A document with the key `base` is another
  /// config with some values replaced: that file is read (`base` starts at this file's folder), and
  /// what stands below `set` is applied as overrides. The folder of `file` is allowed, whatever
  /// else is. Errors: not YAML (with line and column), keys that stand twice, more than a million
  /// nodes (as alias bombs have), an override through a value that has no keys, a base outside of
  /// the allowed folders.
  static Result<ConfigNode> parse(const std::string& text, const std::string& file,
                                  std::vector<Override> overrides = {},
                                  AllowedFolders allowed = {});

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

  /// The file or folder that a scalar names; a relative path starts at the folder of the config
  /// that was given. An error, and nothing, if it is not a text or leads out of the allowed
  /// folders.
  std::optional<std::filesystem::path> named_path(Diagnostics& errors) const;

  /// The files and folders that were read or named so far, in this config and its bases: what
  /// follows from it depends on them.
  const std::vector<std::filesystem::path>& named_files() const { return *source_->named; }

  /// Says of every key that is not among `known` that it is unknown, with "did you mean".
  void refuse_unknown_keys(const std::vector<std::string>& known, Diagnostics& errors) const;

 private:
  struct Source {
    std::string file;  ///< in which the nodes stand
    std::vector<Override> overrides;
    std::filesystem::path folder;  ///< at which relative paths start
    AllowedFolders allowed;
    /// Shared, since nodes are handed out by value and read in any order.
    std::shared_ptr<std::vector<std::filesystem::path>> named;
  };
  static Result<ConfigNode> parse(const std::string& text, Source source, int bases);
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
