#include "page/health.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>

namespace seedframe {
namespace {

constexpr std::int64_t kFewObjects = 20;       // of a class: hardly anything can be learnt of them
constexpr double kRareShare = 0.1;             // of what the classes have on average
constexpr int kSmallSide = 8;                  // pixels: the stride of most detectors' finest level
constexpr double kSmallShare = 0.1;            // of a class's boxes
constexpr double kHiddenShare = 0.25;          // of objects that are seen for less than a tenth
constexpr std::uint16_t kHardlyVisible = 100;  // permille
constexpr double kEmptyShare = 0.1;            // of frames
constexpr double kDark = 8.0;                  // code values
constexpr double kBright = 247.0;
constexpr double kExtremeShare = 0.02;  // of frames
constexpr std::size_t kMostFrames = 200;

/// 0.254 → "25 %", 0.004 → "0.4 %".
std::string percent(double share) {
  const double value = 100.0 * share;
  return value > 0.0 && value < 9.95 ? fmt::format("{:.1f} %", value)
                                     : fmt::format("{:.0f} %", value);
}

/// 12345 → "12,345".
std::string grouped(std::int64_t n) {
  std::string digits = std::to_string(n);
  for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3) {
    digits.insert(static_cast<std::size_t>(at), 1, ',');
  }
  return digits;
}
std::string grouped(std::size_t n) { return grouped(static_cast<std::int64_t>(n)); }

/// "1 group", "2 groups".
std::string counted(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", grouped(n), what, n == 1 ? "" : "s");
}

/// Of many classes with the same fault the first are told each, the others together.
void join_many(std::size_t first, const std::string& title, std::vector<HealthFinding>& findings) {
  constexpr std::size_t kMostListed = 6;
  if (findings.size() <= first + kMostListed) return;
  const auto rest = findings.begin() + static_cast<std::ptrdiff_t>(first + kMostListed) - 1;
  HealthFinding joined = *rest;
  joined.category.clear();
  joined.frames.clear();
  joined.title = fmt::format("{}: {} more", title, findings.end() - rest);
  joined.text.clear();
  for (auto each = rest; each != findings.end(); ++each) {
    joined.text += (joined.text.empty() ? "" : ", ") + each->category;
  }
  findings.erase(rest, findings.end());
  findings.push_back(std::move(joined));
}

double share_of(std::size_t some, std::size_t all) {
  return all == 0 ? 0.0 : static_cast<double>(some) / static_cast<double>(all);
}

bool is_done(const FrameTable& table, std::size_t frame) {
  return table.frames.state[frame] == static_cast<std::uint8_t>(ShownState::kDone);
}

using Visit = std::function<void(std::size_t frame, std::size_t object)>;

/// Objects with a class of which anything is seen.
void for_each_seen(const FrameTable& table, const Visit& visit) {
  for (std::size_t frame = 0; frame < table.frames.size(); ++frame) {
    for (std::size_t i = table.frames.first_object[frame]; i < table.frames.first_object[frame + 1];
         ++i) {
      if (table.objects.category[i] != 0 && table.objects.area_px[i] > 0) visit(frame, i);
    }
  }
}

/// Frames of the campaign, rising, each once.
void note_frame(const FrameTable& table, std::size_t frame, HealthFinding& finding) {
  const auto index = static_cast<std::int64_t>(table.frames.index[frame]);
  if (finding.frames.size() < kMostFrames &&
      (finding.frames.empty() || finding.frames.back() != index)) {
    finding.frames.push_back(index);
  }
}

void check_classes(const HealthFacts& facts, std::vector<HealthFinding>& findings) {
  if (facts.categories.empty()) return;
  std::vector<std::int64_t> counts(facts.categories.size() + 1, 0);
  std::int64_t all = 0;
  for_each_seen(facts.table, [&](std::size_t, std::size_t i) {
    const std::size_t category = facts.table.objects.category[i];
    if (category < counts.size()) ++counts[category];
    ++all;
  });
  const double mean = static_cast<double>(all) / static_cast<double>(facts.categories.size());
  const std::size_t first = findings.size();
  for (std::size_t k = 1; k < counts.size(); ++k) {
    const bool few = counts[k] < kFewObjects;
    const bool rare = static_cast<double>(counts[k]) < kRareShare * mean;
    if (!few && !rare) continue;
    HealthFinding finding{.check = "rare-classes",
                          .level = HealthFinding::Level::kWarning,
                          .title = fmt::format("Class too rare: {}", facts.categories[k - 1]),
                          .text = {},
                          .frames = {},
                          .category = facts.categories[k - 1]};
    if (counts[k] == 0) {
      finding.text = "No frame shows an object of this class.";
    } else {
      finding.text = fmt::format(
          "{} objects of it are seen, where a class has {:.0f} on average. Raise its count, or the "
          "number of frames.",
          grouped(counts[k]), mean);
    }
    for_each_seen(facts.table, [&](std::size_t frame, std::size_t i) {
      if (facts.table.objects.category[i] == k) note_frame(facts.table, frame, finding);
    });
    findings.push_back(std::move(finding));
  }
  join_many(first, "Classes too rare", findings);
  if (findings.size() == first) {
    findings.push_back({"rare-classes",
                        HealthFinding::Level::kGood,
                        "No class is too rare",
                        fmt::format("Each has {} objects or more, and a tenth of the mean ({:.0f}) "
                                    "or more.",
                                    kFewObjects, mean),
                        {},
                        {}});
  }
}

void check_sizes(const HealthFacts& facts, std::vector<HealthFinding>& findings) {
  struct Sizes {
    std::size_t all = 0;
    std::size_t small = 0;
  };
  std::vector<Sizes> sizes(facts.categories.size() + 1);
  const ObjectColumns& objects = facts.table.objects;
  const auto is_small = [&](std::size_t i) {
    return std::min(objects.width[i], objects.height[i]) < kSmallSide;
  };
  for_each_seen(facts.table, [&](std::size_t, std::size_t i) {
    if (objects.category[i] >= sizes.size()) return;
    Sizes& of_class = sizes[objects.category[i]];
    ++of_class.all;
    of_class.small += is_small(i) ? 1U : 0U;
  });
  const std::size_t first = findings.size();
  for (std::size_t k = 1; k < sizes.size(); ++k) {
    const double share = share_of(sizes[k].small, sizes[k].all);
    if (share <= kSmallShare) continue;
    HealthFinding finding{
        "small-boxes",
        HealthFinding::Level::kWarning,
        fmt::format("Boxes too small: {}", facts.categories[k - 1]),
        fmt::format(
            "{} of its {} boxes ({}) have a side below {} px. Move the camera nearer, raise "
            "the resolution, or leave them out of exports with --min-pixels.",
            grouped(sizes[k].small), grouped(sizes[k].all), percent(share), kSmallSide),
        {},
        facts.categories[k - 1]};
    for_each_seen(facts.table, [&](std::size_t frame, std::size_t i) {
      if (objects.category[i] == k && is_small(i)) note_frame(facts.table, frame, finding);
    });
    findings.push_back(std::move(finding));
  }
  join_many(first, "Boxes too small", findings);
  if (findings.size() == first && objects.size() > 0) {
    findings.push_back(
        {"small-boxes",
         HealthFinding::Level::kGood,
         "Boxes are large enough",
         fmt::format("Of no class have more than {} of the boxes a side below {} px.",
                     percent(kSmallShare), kSmallSide),
         {},
         {}});
  }
}

void check_visibility(const HealthFacts& facts, std::vector<HealthFinding>& findings) {
  std::size_t all = 0;
  std::size_t hidden = 0;
  HealthFinding finding{
      "hidden-objects", HealthFinding::Level::kNote, "Many objects are hardly visible", {}, {}, {}};
  for_each_seen(facts.table, [&](std::size_t frame, std::size_t i) {
    ++all;
    if (facts.table.objects.visible_permille[i] >= kHardlyVisible) return;
    ++hidden;
    note_frame(facts.table, frame, finding);
  });
  if (all == 0) return;
  const double share = share_of(hidden, all);
  finding.text =
      fmt::format("{} of {} objects ({}) show less than a tenth of their silhouette{}",
                  grouped(hidden), grouped(all), percent(share),
                  share > kHiddenShare ? ". Exports leave them out with --min-visible 0.1." : ".");
  if (share <= kHiddenShare) {
    finding.level = HealthFinding::Level::kGood;
    finding.title = "Most objects can be seen";
    finding.frames.clear();
  }
  findings.push_back(std::move(finding));
}

void check_empty_frames(const HealthFacts& facts, std::vector<HealthFinding>& findings) {
  std::vector<bool> shows(facts.table.frames.size(), false);
  for_each_seen(facts.table, [&](std::size_t frame, std::size_t) { shows[frame] = true; });
  HealthFinding finding{"empty-frames", HealthFinding::Level::kNote, {}, {}, {}, {}};
  std::size_t all = 0;
  std::size_t empty = 0;
  for (std::size_t frame = 0; frame < shows.size(); ++frame) {
    if (!is_done(facts.table, frame)) continue;
    ++all;
    if (shows[frame]) continue;
    ++empty;
    note_frame(facts.table, frame, finding);
  }
  if (all == 0) return;
  const double share = share_of(empty, all);
  finding.text = fmt::format("{} of {} frames ({}) show no object with a class.", grouped(empty),
                             grouped(all), percent(share));
  if (share > kEmptyShare) {
    finding.level = HealthFinding::Level::kWarning;
    finding.title = "Many frames show nothing";
  } else {
    finding.level = empty == 0 ? HealthFinding::Level::kGood : HealthFinding::Level::kNote;
    finding.title = empty == 0 ? "Every frame shows something" : "Some frames show nothing";
  }
  findings.push_back(std::move(finding));
}

void check_exposure(const HealthFacts& facts, std::vector<HealthFinding>& findings) {
  if (!facts.has_pictures) return;
  HealthFinding finding{"exposure", HealthFinding::Level::kWarning, {}, {}, {}, {}};
  std::size_t all = 0;
  std::size_t dark = 0;
  std::size_t bright = 0;
  for (std::size_t frame = 0; frame < facts.table.frames.size(); ++frame) {
    if (!is_done(facts.table, frame)) continue;
    ++all;
    const double luma = facts.table.frames.luma[frame];
    dark += luma <= kDark ? 1U : 0U;
    bright += luma >= kBright ? 1U : 0U;
    if (luma <= kDark || luma >= kBright) note_frame(facts.table, frame, finding);
  }
  if (all == 0) return;
  const double share = share_of(dark + bright, all);
  finding.title = share > kExtremeShare ? "Pictures are nearly black or nearly white"
                                        : "Pictures are well exposed";
  finding.text = fmt::format("{} of {} pictures are nearly black, and {} nearly white.",
                             grouped(dark), grouped(all), grouped(bright));
  if (share <= kExtremeShare) {
    finding.level = HealthFinding::Level::kGood;
    finding.frames.clear();
  }
  findings.push_back(std::move(finding));
}

void check_duplicates(const HealthFacts& facts, std::vector<HealthFinding>& findings) {
  if (facts.table.objects.size() == 0 && !facts.has_pictures) return;
  HealthFinding finding{"near-duplicates", HealthFinding::Level::kGood, {}, {}, {}, {}};
  std::size_t repeated = 0;
  for (const std::vector<std::size_t>& group : facts.duplicates) {
    repeated += group.size() - 1;
    for (const std::size_t frame : group) note_frame(facts.table, frame, finding);
  }
  if (repeated == 0) {
    finding.title = "No frames are near-duplicates";
    finding.text = "No two show the same objects in the same places and colours.";
  } else {
    finding.level = HealthFinding::Level::kWarning;
    finding.title = counted(repeated, "near-duplicate frame");
    finding.text = fmt::format(
        "They show the same objects in the same places{} as another frame, in {}. Draw more "
        "anew for each frame.",
        facts.has_pictures ? " and colours" : "", counted(facts.duplicates.size(), "group"));
  }
  findings.push_back(std::move(finding));
}

/// Frames of a duplicate group that are in two splits of one export.
std::size_t leaked_duplicates(const HealthFacts& facts, const std::string& format) {
  std::map<std::int64_t, std::string> split_of;
  for (const SplitScenes& split : facts.splits) {
    if (split.format != format) continue;
    for (const std::int64_t frame : split.frames) split_of[frame] = split.split;
  }
  std::size_t leaked = 0;
  for (const std::vector<std::size_t>& group : facts.duplicates) {
    std::set<std::string> splits;
    for (const std::size_t place : group) {
      const auto found = split_of.find(static_cast<std::int64_t>(facts.table.frames.index[place]));
      if (found != split_of.end()) splits.insert(found->second);
    }
    leaked += splits.size() > 1 ? 1U : 0U;
  }
  return leaked;
}

void check_splits(const HealthFacts& facts, std::vector<HealthFinding>& findings) {
  std::map<std::string, std::map<std::int64_t, std::set<std::string>>> splits_of_scene;
  for (const SplitScenes& split : facts.splits) {
    for (const std::int64_t scene : split.scenes) {
      splits_of_scene[split.format][scene].insert(split.split);
    }
  }
  for (const auto& [format, scenes] : splits_of_scene) {
    std::size_t leaking = 0;
    std::int64_t first = -1;
    for (const auto& [scene, splits] : scenes) {
      if (splits.size() < 2) continue;
      ++leaking;
      if (first < 0) first = scene;
    }
    const std::size_t duplicates = leaked_duplicates(facts, format);
    HealthFinding finding{"leaking-splits", HealthFinding::Level::kGood, {}, {}, {}, {}};
    finding.title = fmt::format("Splits of {} share no scene", format);
    finding.text = counted(scenes.size(), "scene") + ", each in one split.";
    if (leaking > 0 || duplicates > 0) {
      finding.level = HealthFinding::Level::kWarning;
      finding.title = fmt::format("Splits of {} leak", format);
      finding.text =
          leaking > 0
              ? fmt::format(
                    "In more than one split: {}, the first is scene {}. What is validated "
                    "on was trained on.",
                    counted(leaking, "scene"), first)
              : counted(duplicates, "group") + " of near-duplicates in more than one split.";
    }
    findings.push_back(std::move(finding));
  }
}

}  // namespace

const char* to_string(HealthFinding::Level level) {
  switch (level) {
    case HealthFinding::Level::kGood:
      return "good";
    case HealthFinding::Level::kNote:
      return "note";
    case HealthFinding::Level::kWarning:
      return "warning";
  }
  return "";
}

std::vector<HealthFinding> check_health(const HealthFacts& facts) {
  std::vector<HealthFinding> findings;
  if (facts.table.frames.size() == 0) return findings;
  const auto& states = facts.table.frames.state;
  const bool any = std::find(states.begin(), states.end(),
                             static_cast<std::uint8_t>(ShownState::kDone)) != states.end();
  if (!any) return findings;  // nothing can be said of frames that are not there
  check_classes(facts, findings);
  check_sizes(facts, findings);
  check_visibility(facts, findings);
  check_empty_frames(facts, findings);
  check_exposure(facts, findings);
  check_duplicates(facts, findings);
  check_splits(facts, findings);
  return findings;
}

Json to_json(const HealthFinding& finding) {
  Json json = {{"check", finding.check},
               {"level", to_string(finding.level)},
               {"title", finding.title},
               {"text", finding.text}};
  if (!finding.frames.empty()) json["frames"] = finding.frames;
  if (!finding.category.empty()) json["category"] = finding.category;
  return json;
}

}  // namespace seedframe
