// RayScene::silhouette.
#include <algorithm>
#include <array>
#include <cstring>

#include "rays/projected_box.h"
#include "rays/projected_outline.h"
#include "rays/ray_packet.h"
#include "rays/scene_trees.h"

namespace seedframe {
namespace {

/// Traces pixels of a mask eight at a time, whatever lies between them.
class PixelQueue {
 public:
  PixelQueue(const PixelCamera& camera, const PixelRays& pixels, RTCScene tree, unsigned mask)
      : pixels_(pixels), tree_(tree), mask_(mask), packet_(camera) {}

  /// `pixel` becomes 1 or 0, at the end() at the latest.
  void add(int x, int y, std::uint8_t& pixel) {
    packet_.aim_lane(count_, pixels_.x(x), pixels_.y(y));
    targets_[count_] = &pixel;
    if (++count_ == RayPacket::kLanes) trace();
  }

  void end() {
    for (std::size_t lane = count_; lane < RayPacket::kLanes; ++lane) packet_.wanted[lane] = 0;
    if (count_ > 0) trace();
  }

 private:
  void trace() {
    packet_.find_any_hits(tree_, mask_);
    for (std::size_t lane = 0; lane < count_; ++lane) *targets_[lane] = packet_.hits(lane) ? 1 : 0;
    count_ = 0;
  }

  const PixelRays& pixels_;
  RTCScene tree_;
  unsigned mask_;
  RayPacket packet_;
  std::array<std::uint8_t*, RayPacket::kLanes> targets_{};
  std::size_t count_ = 0;
};

/// One row of a mask: what the box and the traced image tell of it. Returns how many pixels must be
/// traced.
std::int64_t draft_row(const ProjectedBox& box, const RayImage& image, std::int32_t index, int y,
                       MaskDraft& draft) {
  std::uint8_t* row = draft.row(y) - draft.rect.x;  // by column
  const auto [begin, end] = box.columns_met(y);
  std::fill(row + begin, row + end, kUnknown);
  if (y < 0 || y >= image.height) return end - begin;
  const std::size_t in_image = image.index(0, y);
  const int first = std::clamp(0, begin, end);
  const int last = std::clamp(image.width, begin, end);
  if (!image.depth.empty()) {
    box.find_met_before(y, first, last - first, image.depth.data() + in_image + first, row + first);
    for (int x = first; x < last; ++x) row[x] = row[x] == 0 ? 0 : kUnknown;
  }
  const std::int32_t* shown = image.instance.data() + in_image;
  for (int x = std::max(0, draft.rect.x); x < std::min(image.width, draft.rect.end_x()); ++x) {
    row[x] = shown[x] == index ? kSet : row[x];
  }
  return std::count(row + begin, row + end, kUnknown);
}

/// In the order of packets, since neighbours go the same ways.
void trace_unknown(MaskDraft& draft, PixelQueue& queue) {
  const PixelRect& rect = draft.rect;
  for (int top = rect.y; top < rect.end_y(); top += RayPacket::kRows) {
    const int bottom = std::min(top + RayPacket::kRows, rect.end_y());
    for (int left = 0; left < rect.width; left += RayPacket::kColumns) {
      const int right = std::min(left + RayPacket::kColumns, rect.width);
      for (int y = top; y < bottom; ++y) {
        std::uint8_t* row = draft.row(y);
        for (int x = left; x < right; ++x) {
          if (row[x] == kUnknown) queue.add(rect.x + x, y, row[x]);
        }
      }
    }
  }
  queue.end();
}

/// Cuts a mask down to the pixels that are set.
Silhouette tight_silhouette(MaskDraft& draft, const PixelCamera& camera) {
  const PixelRect& rect = draft.rect;
  Silhouette silhouette;
  int low_x = rect.width, high_x = -1, low_y = rect.end_y(), high_y = rect.y - 1;
  const int image_begin = std::clamp(-rect.x, 0, rect.width);
  const int image_end = std::clamp(camera.width - rect.x, 0, rect.width);
  for (int y = rect.y; y < rect.end_y(); ++y) {
    const std::uint8_t* row = draft.row(y);
    const auto* first =
        static_cast<const std::uint8_t*>(std::memchr(row, 1, static_cast<std::size_t>(rect.width)));
    if (first == nullptr) continue;
    const auto* last =
        static_cast<const std::uint8_t*>(::memrchr(row, 1, static_cast<std::size_t>(rect.width)));
    low_x = std::min(low_x, static_cast<int>(first - row));
    high_x = std::max(high_x, static_cast<int>(last - row));
    low_y = std::min(low_y, y);
    high_y = y;
    silhouette.area_px += std::count(first, last + 1, 1);
    if (y >= 0 && y < camera.height && image_begin < image_end) {
      silhouette.in_image_px += std::count(row + image_begin, row + image_end, 1);
    }
  }
  if (high_x < 0) return silhouette;
  silhouette.box = {rect.x + low_x, low_y, high_x - low_x + 1, high_y - low_y + 1};
  silhouette.mask.reserve(static_cast<std::size_t>(silhouette.box.area()));
  for (int y = low_y; y <= high_y; ++y) {
    const std::uint8_t* row = draft.row(y);
    silhouette.mask.insert(silhouette.mask.end(), row + low_x, row + high_x + 1);
  }
  const PixelRect canvas = enlarged_canvas(camera);
  const PixelRect& box = silhouette.box;
  silhouette.complete = box.x > canvas.x && box.y > canvas.y && box.end_x() < canvas.end_x() &&
                        box.end_y() < canvas.end_y();
  return silhouette;
}

}  // namespace

Silhouette RayScene::silhouette(std::size_t index, const RayImage& image,
                                const PixelRect& within) const {
  if (!scene_->instances[index].seen) return {};
  const ProjectedBox& box = scene_->boxes[index];
  const PixelRect rect = union_of(within, box.rect());
  if (rect.empty()) return {};
  MaskDraft draft(rect);
  std::int64_t unknown = 0;
  for (int y = rect.y; y < rect.end_y(); ++y) {
    unknown += draft_row(box, image, static_cast<std::int32_t>(index), y, draft);
  }
  // A pixel's ray costs as much as some triangles' part in the outline.
  constexpr std::int64_t kTrianglesPerRay = 6;
  const RayInstance& instance = scene_->instances[index];
  if (kTrianglesPerRay * unknown > static_cast<std::int64_t>(instance.mesh->triangle_count())) {
    unknown = fill_outline(*instance.mesh, instance.camera_from_object, scene_->camera, draft);
  }
  if (unknown > 0) {
    // A tree of its own costs as much as some hundred rays, and each ray is cheaper there.
    constexpr std::int64_t kWorthATree = 1000;
    const bool own_tree = unknown > kWorthATree || !scene_->has_own_mask(index);
    PixelQueue queue(scene_->camera, scene_->pixels, own_tree ? scene_->only(index) : scene_->all,
                     own_tree ? RayPacket::kEveryInstance : scene_->masks[index]);
    trace_unknown(draft, queue);
  }
  return tight_silhouette(draft, scene_->camera);
}

}  // namespace seedframe
