// What a look at a dataset as a whole warns of.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "page/frame_table.h"

namespace seedframe {

/// A part of an export, and the scenes that its frames are of.
struct SplitScenes {
  std::string format;
  std::string split;
  std::vector<std::int64_t> frames;  ///< in the campaign, rising
  std::vector<std::int64_t> scenes;  ///< rising, each once
};

struct HealthFacts {
  const FrameTable& table;
  std::vector<std::string> categories;
  int image_width = 0;
  bool has_pictures = true;
  std::vector<std::vector<std::size_t>> duplicates;  ///< places in the table
  std::vector<SplitScenes> splits;
};

/// One check, passed or not.
struct HealthFinding {
  enum class Level { kGood, kNote, kWarning };
  std::string check;  ///< "rare-classes": names it for programs
  Level level = Level::kGood;
  std::string title;
  std::string text;                  ///< what was found, with its numbers, and what to do
  std::vector<std::int64_t> frames;  ///< of the campaign: some that show it
  std::string category;              ///< that it is about, if it is one
};
const char* to_string(HealthFinding::Level level);

/// Every check, in one order; those that have nothing to look at are left out.
std::vector<HealthFinding> check_health(const HealthFacts& facts);

Json to_json(const HealthFinding& finding);

}  // namespace seedframe
