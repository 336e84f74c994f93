// docs/config.md, as tests read it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/files.h"

namespace seedframe {

inline std::string config_page() {
  const auto text = read_file(std::filesystem::path(SEEDFRAME_HOME) / "docs" / "config.md");
  EXPECT_TRUE(text);
  return text.value_or("");
}

/// The page's yaml blocks as whole configs: what shows only some sections gets a version,
/// categories and a camera.
inline std::vector<std::string> config_page_examples() {
  std::vector<std::string> examples;
  const std::string page = config_page();
  const std::string fence = "```yaml\n";
  for (std::size_t start = page.find(fence); start != std::string::npos;
       start = page.find(fence, start)) {
    start += fence.size();
    std::string text = page.substr(start, page.find("```", start) - start);
    if (!text.starts_with("seedframe:")) {
      const bool has_camera = ("\n" + text).find("\ncamera:") != std::string::npos;
      text += "\nseedframe: 1\ncategories: [gear, hex_bolt, hex_nut, washer]\n";
      if (!has_camera) text += "camera: {distance_m: 1}\n";
    }
    examples.push_back(std::move(text));
  }
  return examples;
}

}  // namespace seedframe
