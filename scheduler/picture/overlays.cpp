#include "picture/overlays.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "annotate/boundary.h"
#include "annotate/rle.h"
#include "picture/pixel_layers.h"

namespace seedframe {
namespace {

using Rings = std::vector<std::vector<CanvasPoint>>;

/// The boundary of a mask whose pixel 0, 0 is at `x`, `y` of the frame, on the canvas.
Rings rings_of(const Mask& mask, int x, int y, double scale) {
  // Where a walk along the side of a pixel begins.
  constexpr std::array<std::array<int, 2>, 4> kCorner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const Boundary boundary = trace_boundary(mask);
  Rings rings;
  rings.reserve(boundary.rings.size());
  for (const CrackRing& ring : boundary.rings) {
    std::vector<CanvasPoint>& points = rings.emplace_back();
    for (std::size_t i = 0; i < ring.count; ++i) {
      const Crack& crack = boundary.cracks[ring.first + i];
      const Crack& before = boundary.cracks[ring.first + (i == 0 ? ring.count : i) - 1];
      if (before.side == crack.side) continue;
      const auto& corner = kCorner[static_cast<std::size_t>(crack.side)];
      points.push_back(
          {scale * (x + crack.column + corner[0]), scale * (y + crack.row + corner[1])});
    }
  }
  return rings;
}

Rings silhouette_rings(const AmodalLabel& amodal, double scale) {
  constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;  // whatever a file says
  if (amodal.box.area() <= 0 || amodal.box.area() > kMostPixels) return {};
  const auto rle = rle_from_string(amodal.rle, amodal.box.width, amodal.box.height);
  if (!rle) return {};
  Image<std::uint16_t> mask(amodal.box.width, amodal.box.height);
  for_each_stretch(*rle, [&](int column, int first, int end) {
    for (int row = first; row < end; ++row) mask.at(row, column) = 1;
  });
  return rings_of(Mask(mask, 1, {0, 0, mask.width, mask.height}), amodal.box.x, amodal.box.y,
                  scale);
}

class Overlays {
 public:
  Overlays(const FrameContent& content, double scale, Canvas& canvas)
      : content_(content), scale_(scale), canvas_(canvas) {
    for (const InstanceLabel& label : content.labels.instances) {
      if (label.area_px > 0) seen_.push_back(&label);
    }
    // The largest first: those behind show on them, and names of the largest have room.
    std::stable_sort(seen_.begin(), seen_.end(),
                     [](const auto* a, const auto* b) { return a->box.area() > b->box.area(); });
  }

  void draw_mask_outlines() {
    const std::map<int, DisplayColor> colors = instance_colors(content_.labels);
    for (const InstanceLabel* label : seen_) {
      const Rings rings =
          rings_of(Mask(content_.instance_ids, label->id, label->box), 0, 0, scale_);
      canvas_.rings(rings, {.color = colors.at(label->id), .width = line_width()});
    }
  }

  void draw_silhouettes() {
    for (const InstanceLabel& label : content_.labels.instances) {
      if (label.category == 0 || !label.amodal) continue;
      const Rings rings = silhouette_rings(*label.amodal, scale_);
      canvas_.rings(rings, {.color = {0.0, 0.0, 0.0}, .width = line_width() + 1.0, .opacity = 0.5});
      canvas_.rings(rings, {.color = class_color(label.category), .width = line_width()});
    }
  }

  void draw_boxes() {
    for (const InstanceLabel* label : seen_) {
      if (label->category == 0) continue;
      CanvasBox box = box_of(*label);
      canvas_.outline({box.x - 1.0, box.y - 1.0, box.width + 2.0, box.height + 2.0},
                      {.color = {0.0, 0.0, 0.0}, .width = line_width() + 2.0, .opacity = 0.35});
      canvas_.outline(box, {.color = class_color(label->category), .width = line_width()});
    }
  }

  void draw_keypoints(const Skeletons& skeletons) {
    const double radius = std::clamp(canvas_.width() / 130.0, 3.0, 4.5);
    for (const InstanceLabel* label : seen_) {
      if (label->category == 0) continue;
      const DisplayColor color = class_color(label->category);
      draw_skeleton(*label, skeletons, color);
      for (const KeypointLabel& point : label->keypoints) {
        if (point.visibility == Visibility::kOutside) continue;
        const CanvasPoint at = {scale_ * point.px[0], scale_ * point.px[1]};
        canvas_.disc(at, radius + 1.0, {.color = {0.0, 0.0, 0.0}, .is_filled = true});
        canvas_.disc(at, radius, {.color = {1.0, 1.0, 1.0}, .is_filled = true});
        const bool visible = point.visibility == Visibility::kVisible;
        canvas_.disc(at, visible ? radius - 0.5 : radius - 0.75,
                     {.color = color, .width = 1.5, .is_filled = visible});
      }
    }
  }

  void draw_names() {
    const TextStyle style{.size = std::clamp(canvas_.width() / 34.0, 9.0, 13.0)};
    std::vector<CanvasBox> taken;
    for (const InstanceLabel* label : seen_) {
      if (label->category == 0) continue;
      const std::string name = canvas_.fitted(
          content_.labels.categories.at(static_cast<std::size_t>(label->category) - 1),
          0.5 * canvas_.width(), style);
      const double width = canvas_.width_of(name, style) + 0.6 * style.size;
      const std::optional<CanvasBox> place = place_for(*label, width, 1.3 * style.size, taken);
      if (!place) continue;
      taken.push_back(*place);
      const DisplayColor color = class_color(label->category);
      canvas_.fill(*place, color, 0.9);
      canvas_.text(name, {place->x + 0.3 * style.size, place->y + 1.0 * style.size},
                   {.size = style.size, .color = ink_on(color)});
    }
  }

 private:
  double line_width() const { return canvas_.width() < 480 ? 1.0 : 1.5; }

  /// On whole pixels, so that its lines are sharp.
  CanvasBox box_of(const InstanceLabel& label) const {
    const double x = std::floor(scale_ * label.box.x), y = std::floor(scale_ * label.box.y);
    return {x, y, std::ceil(scale_ * label.box.end_x()) - x,
            std::ceil(scale_ * label.box.end_y()) - y};
  }

  void draw_skeleton(const InstanceLabel& label, const Skeletons& skeletons,
                     const DisplayColor& color) {
    const auto category = static_cast<std::size_t>(label.category) - 1;
    if (category >= skeletons.size()) return;
    const auto point_of = [&](const std::string& name) -> const KeypointLabel* {
      const auto found = std::find_if(label.keypoints.begin(), label.keypoints.end(),
                                      [&](const auto& point) { return point.name == name; });
      const bool is_there =
          found != label.keypoints.end() && found->visibility != Visibility::kOutside;
      return is_there ? &*found : nullptr;
    };
    for (const auto& [first, second] : skeletons[category]) {
      const KeypointLabel *from = point_of(first), *to = point_of(second);
      if (from == nullptr || to == nullptr) continue;
      const CanvasPoint begin = {scale_ * from->px[0], scale_ * from->px[1]};
      const CanvasPoint end = {scale_ * to->px[0], scale_ * to->px[1]};
      canvas_.line(begin, end, {.color = {0.0, 0.0, 0.0}, .width = 3.5, .opacity = 0.5});
      canvas_.line(begin, end, {.color = color, .width = 2.0});
    }
  }

  /// Beside the box or within it, where no other name is and as little as can be of other objects
  /// is covered. None: there would be too little left of one.
  std::optional<CanvasBox> place_for(const InstanceLabel& label, double width, double height,
                                     const std::vector<CanvasBox>& taken) const {
    constexpr double kMostCovered = 0.75;  // of one object's box
    const CanvasBox box = box_of(label);
    const double right = box.x + box.width - width, below = box.y + box.height;
    std::optional<CanvasBox> best;
    double least = kMostCovered;
    for (const CanvasPoint& at :
         {CanvasPoint{box.x, box.y - height}, CanvasPoint{right, box.y - height},
          CanvasPoint{box.x, below}, CanvasPoint{right, below}, CanvasPoint{box.x, box.y},
          CanvasPoint{right, box.y}, CanvasPoint{box.x, below - height},
          CanvasPoint{box.x + box.width, box.y}, CanvasPoint{box.x - width, box.y}}) {
      const CanvasBox place = {std::round(std::clamp(at[0], 0.0, canvas_.width() - width)),
                               std::round(std::clamp(at[1], 0.0, canvas_.height() - height)), width,
                               height};
      const double covered = covered_by(place, label, taken);
      if (covered >= least) continue;
      least = covered;
      best = place;
    }
    return best;
  }

  /// The largest share of an object's box that a name would cover; 1 or more where a name is. Of
  /// its own object half as much counts.
  double covered_by(const CanvasBox& place, const InstanceLabel& label,
                    const std::vector<CanvasBox>& taken) const {
    if (place.x < 0.0 || place.y < 0.0) return 1.0;
    double most = 0.0;
    for (const CanvasBox& other : taken) {
      if (place.overlaps(other)) return 1.0;
    }
    for (const InstanceLabel* other : seen_) {
      const CanvasBox box = box_of(*other);
      const double share = place.overlap(box) / (box.width * box.height);
      most = std::max(most, other == &label ? 0.5 * share : share);
    }
    return most;
  }

  const FrameContent& content_;
  double scale_;
  Canvas& canvas_;
  std::vector<const InstanceLabel*> seen_;
};

}  // namespace

void draw_overlays(const FrameContent& content, const LayerSet& layers, double scale,
                   const Skeletons& skeletons, Canvas& canvas) {
  Overlays overlays(content, scale, canvas);
  if (layers.has(Layer::kInstances) && layers.has(Layer::kImage)) overlays.draw_mask_outlines();
  if (layers.has(Layer::kAmodal)) overlays.draw_silhouettes();
  if (layers.has(Layer::kBoxes)) overlays.draw_boxes();
  if (layers.has(Layer::kKeypoints)) overlays.draw_keypoints(skeletons);
  if (layers.has(Layer::kNames)) overlays.draw_names();
}

}  // namespace seedframe
