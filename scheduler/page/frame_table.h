// What a page knows of frames and objects, column by column.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/canonical_json.h"

namespace seedframe {

/// As store/job_store.h has them, and one more.
enum class ShownState : std::uint8_t { kPending, kRunning, kDone, kFailed, kQuarantined, kDamaged };

/// Texts, each once; others refer to it by its place.
class TextTable {
 public:
  std::uint32_t place_of(const std::string& text);
  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::vector<std::string> texts_;
  std::map<std::string, std::uint32_t> places_;
};

/// One entry for each frame that is shown, in the order of frames.
struct FrameColumns {
  std::vector<std::uint32_t> index;  ///< in the campaign
  std::vector<std::uint32_t> scene;
  std::vector<std::uint8_t> state;  ///< ShownState
  std::vector<std::uint16_t> attempts;
  std::vector<std::int32_t> worker;                ///< of the good attempt; -1: none
  std::vector<float> build_s, render_s, finish_s;  ///< of the good attempt; NaN: there is none
  std::vector<std::uint8_t> luma;                  ///< mean of the picture; 0 without one
  std::vector<std::uint32_t> first_object;         ///< one more than frames

  std::size_t size() const { return index.size(); }
};

/// One entry for each instance with an id, frame by frame.
struct ObjectColumns {
  static constexpr std::uint16_t kUnknown = 65'535;

  std::vector<std::uint16_t> id;
  std::vector<std::uint16_t> category;             ///< 1-based; 0: a distractor
  std::vector<std::uint16_t> asset;                ///< place in FrameTable::assets
  std::vector<std::uint32_t> name;                 ///< place in FrameTable::names
  std::vector<std::uint16_t> x, y, width, height;  ///< of the visible pixels; all 0: none
  std::vector<std::uint32_t> area_px;              ///< visible
  std::vector<std::uint16_t> visible_permille;     ///< of the silhouette; or kUnknown
  std::vector<std::uint16_t> truncation_permille;  ///< outside the image; or kUnknown
  std::vector<float> distance_m;                   ///< from the camera; NaN: unknown

  std::size_t size() const { return id.size(); }
};

struct FrameTable {
  FrameColumns frames;
  ObjectColumns objects;
  TextTable assets;
  TextTable names;
};

/// docs/report.md has the keys.
Json to_json(const FrameColumns& frames);
Json to_json(const ObjectColumns& objects);

}  // namespace seedframe
