#include "page/near_duplicates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace seedframe {
namespace {

/// The most comparisons with one frame: where thousands look alike, their neighbours tell it.
constexpr std::size_t kMostNeighbours = 400;

struct VisibleBox {
  std::uint16_t category = 0;
  std::array<double, 4> sides{};  ///< left, top, right, bottom

  bool operator<(const VisibleBox& other) const {
    return std::tie(category, sides) < std::tie(other.category, other.sides);
  }
};

struct Candidate {
  std::size_t place = 0;
  double key = 0.0;  ///< frames whose keys are further apart than `reach` are not near
  std::vector<VisibleBox> boxes;
};

std::vector<VisibleBox> visible_boxes(const FrameTable& table, std::size_t frame) {
  const ObjectColumns& objects = table.objects;
  std::vector<VisibleBox> boxes;
  for (std::size_t i = table.frames.first_object[frame]; i < table.frames.first_object[frame + 1];
       ++i) {
    if (objects.category[i] == 0 || objects.area_px[i] == 0) continue;
    const double x = objects.x[i];
    const double y = objects.y[i];
    boxes.push_back({objects.category[i], {x, y, x + objects.width[i], y + objects.height[i]}});
  }
  std::sort(boxes.begin(), boxes.end());
  return boxes;
}

bool boxes_are_near(const std::vector<VisibleBox>& a, const std::vector<VisibleBox>& b,
                    double most) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t side = 0; side < 4; ++side) {
      if (std::abs(a[i].sides[side] - b[i].sides[side]) > most) return false;
    }
  }
  return true;
}

bool pictures_are_near(const std::optional<PictureSignature>& a,
                       const std::optional<PictureSignature>& b, double most) {
  if (!a || !b) return !a && !b;
  double sum = 0.0;
  for (std::size_t i = 0; i < a->size(); ++i) {
    const double difference = static_cast<double>((*a)[i]) - static_cast<double>((*b)[i]);
    sum += difference * difference;
  }
  return sum <= most * most * static_cast<double>(a->size());
}

/// Sets of places that were joined, each known by its least.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::vector<std::size_t>> of_two_or_more() {
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < parent_.size(); ++i) members[root(i)].push_back(i);
    std::vector<std::vector<std::size_t>> groups;
    for (auto& [first, group] : members) {
      if (group.size() > 1) groups.push_back(std::move(group));
    }
    return groups;
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

std::vector<std::vector<std::size_t>> near_duplicates(
    const FrameTable& table, const std::vector<std::optional<PictureSignature>>& signatures,
    int image_width, const DuplicateRules& rules) {
  const double most = std::max(rules.least_box_px, rules.box_share * image_width);
  // By how often each class is seen: only these can be near.
  std::map<std::vector<std::uint16_t>, std::vector<Candidate>> alike;
  for (std::size_t frame = 0; frame < table.frames.size(); ++frame) {
    if (table.frames.state[frame] != static_cast<std::uint8_t>(ShownState::kDone)) continue;
    Candidate candidate{frame, 0.0, visible_boxes(table, frame)};
    std::vector<std::uint16_t> classes;
    for (const VisibleBox& box : candidate.boxes) {
      classes.push_back(box.category);
      candidate.key += box.sides[0] / static_cast<double>(candidate.boxes.size());
    }
    if (classes.empty()) {
      if (!signatures[frame]) continue;
      candidate.key = mean_luma(*signatures[frame]);
    }
    alike[std::move(classes)].push_back(std::move(candidate));
  }
  Groups groups(table.frames.size());
  for (auto& [classes, candidates] : alike) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.key < b.key; });
    const double reach = classes.empty() ? rules.code_values : most;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const std::size_t end = std::min(candidates.size(), i + 1 + kMostNeighbours);
      for (std::size_t k = i + 1; k < end && candidates[k].key - candidates[i].key <= reach; ++k) {
        const Candidate& a = candidates[i];
        const Candidate& b = candidates[k];
        if (boxes_are_near(a.boxes, b.boxes, most) &&
            pictures_are_near(signatures[a.place], signatures[b.place], rules.code_values)) {
          groups.join(a.place, b.place);
        }
      }
    }
  }
  return groups.of_two_or_more();
}

}  // namespace seedframe
