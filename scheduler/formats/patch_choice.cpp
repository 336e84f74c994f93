#include "formats/patch_choice.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace seedframe {
namespace {

constexpr double kSpareFrames = 1.1;  ///< frames differ
constexpr double kRoundingOfFrames = 1e-9;
constexpr double kLeastGrowth = 1.01;

/// The candidates of a class in a split, in the order in which they are taken.
void sort_by_turn(std::vector<PatchCandidate>& candidates) {
  const auto key = [](const PatchCandidate& each) {
    return std::tuple(each.draw, each.frame, each.number);
  };
  std::sort(candidates.begin(), candidates.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::map<std::int64_t, int> of_frame;
  std::vector<std::pair<int, PatchCandidate>> turns;
  turns.reserve(candidates.size());
  for (const PatchCandidate& each : candidates) turns.emplace_back(of_frame[each.frame]++, each);
  std::stable_sort(turns.begin(), turns.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < turns.size(); ++i) candidates[i] = turns[i].second;
}

/// What is missing, and what would help.
class Shortage {
 public:
  explicit Shortage(const PatchDemand& demand) : demand_(demand) {}

  void add(int category, std::size_t split, std::size_t found, std::size_t of_class, int wanted) {
    const std::string& name = demand_.class_names[static_cast<std::size_t>(category) - 1];
    found_ += fmt::format("\n  {}: {} of {}", name, found, wanted);
    if (demand_.splits.size() > 1) found_ += " in " + demand_.splits[split].name;
    if (of_class == 0) {
      if (never_.find("'" + name + "'") == std::string::npos) {
        never_ += fmt::format("{}'{}'", never_.empty() ? "" : ", ", name);
      }
      return;
    }
    // A split that has none says less of how many there would be than all splits together.
    const double there =
        found > 0 ? static_cast<double>(found)
                  : static_cast<double>(of_class) * std::max(demand_.splits[split].share, 1e-6);
    growth_ = std::max({growth_, wanted / there, kLeastGrowth});
  }

  explicit operator bool() const { return !found_.empty(); }

  tl::unexpected<Error> error() const {
    std::string advice;
    if (growth_ > 0.0) {
      const auto frames = static_cast<std::int64_t>(std::ceil(
          static_cast<double>(demand_.frames) * growth_ * kSpareFrames - kRoundingOfFrames));
      advice = fmt::format(
          "\nabout {} frames should have them, {} more than campaign '{}' has: "
          "raise its scenes",
          frames, frames - demand_.frames, demand_.campaign);
    }
    if (!never_.empty()) {
      advice += fmt::format(
          "\nno frame that is there has a patch of {}: lower --min-side, "
          "--min-pixels or --min-visible, or name with --classes only those "
          "that the scenes show",
          never_);
    }
    return fail(ErrorKind::kInput, "--per-class {}: the {} frames have too few patches of{}{}",
                demand_.per_class, demand_.frames, found_, advice);
  }

 private:
  const PatchDemand& demand_;
  std::string found_;
  std::string never_;
  double growth_ = 0.0;  ///< how many times the frames; 0: more frames are not what is missing
};

}  // namespace

std::vector<int> patches_of_splits(int per_class, const std::vector<SplitShare>& splits) {
  std::vector<int> wanted(splits.size());
  double end = 0.0;
  int given = 0;
  for (std::size_t i = splits.size(); i-- > 1;) {
    end += splits[i].share;
    wanted[i] = static_cast<int>(std::lround(end * per_class)) - given;
    given += wanted[i];
  }
  wanted[0] = per_class - given;
  return wanted;
}

Result<std::map<std::int64_t, ChosenPatches>> choose_patches(std::vector<PatchCandidate> candidates,
                                                             const PatchDemand& demand) {
  std::map<std::pair<int, int>, std::vector<PatchCandidate>> groups;  // by category and split
  for (const PatchCandidate& each : candidates) {
    groups[{each.category, each.split}].push_back(each);
  }
  candidates.clear();
  const std::vector<int> wanted = patches_of_splits(demand.per_class, demand.splits);
  std::map<std::int64_t, ChosenPatches> chosen;
  Shortage shortage(demand);
  for (const int category : demand.categories) {
    std::size_t of_class = 0;
    for (std::size_t split = 0; split < wanted.size(); ++split) {
      of_class += groups[{category, static_cast<int>(split)}].size();
    }
    for (std::size_t split = 0; split < wanted.size(); ++split) {
      const int number = wanted[split];
      std::vector<PatchCandidate>& group = groups[{category, static_cast<int>(split)}];
      if (static_cast<int>(group.size()) < number) {
        shortage.add(category, split, group.size(), of_class, number);
        continue;
      }
      sort_by_turn(group);
      for (int i = 0; i < number; ++i) {
        const PatchCandidate& each = group[static_cast<std::size_t>(i)];
        chosen[each.frame].emplace_back(category, each.number);
      }
    }
  }
  if (shortage) return shortage.error();
  for (auto& [frame, patches] : chosen) std::sort(patches.begin(), patches.end());
  return chosen;
}

}  // namespace seedframe
