// docs/config.md and docs/config/values.md, as tests read them: as one page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/files.h"

namespace seedframe {

inline std::string config_page() {
  std::string page;
  for (const char* file : {"config.md", "config/values.md"}) {
    const auto text = read_file(std::filesystem::path(SEEDFRAME_HOME) / "docs" / file);
    EXPECT_TRUE(text) << file;
    page += text.value_or("") + "\n";
  }
  return page;
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
