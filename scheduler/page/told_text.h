// Messages and logs as a page may show them: UTF-8, and without where the campaign lies here.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace seedframe {

class ToldText {
 public:
  /// The campaign's folder is told by its name.
  explicit ToldText(const std::filesystem::path& root);

  const std::string& name() const { return name_; }
  std::string of(std::string_view text) const;

 private:
  std::string name_;
  std::vector<std::string> paths_;  ///< of the folder, the longest first
};

/// With the last part alone of each absolute path: "/home/me/parts.yaml:3:1" → "parts.yaml:3:1".
std::string without_folders(std::string_view text);

}  // namespace seedframe
