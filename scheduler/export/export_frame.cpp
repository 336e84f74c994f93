#include "export/export_frame.h"

#include <algorithm>

#include "annotate/rle.h"
#include "frames/campaign_files.h"

namespace seedframe {

PlacedFile image_at(const std::filesystem::path& path, const ExportFrame& frame) {
  return {path, frame.frame.folder / frame.loaded.image_file, frame.loaded.image_sha256};
}

std::string image_name(const ExportFrame& frame) {
  return frame.stem + std::filesystem::path(frame.loaded.image_file).extension().string();
}

Result<ExportInstance> whole_instance(const CommittedFrame& frame, const LoadedFrame& loaded,
                                      const InstanceLabel& label) {
  if (!loaded.labels.twin_exact || !label.amodal) {
    return fail(ErrorKind::kInput,
                "frame {}: its textures cut holes, which silhouettes do not show: export "
                "without whole silhouettes (--amodal, bop)",
                frame.index);
  }
  const PixelRect& rect = label.amodal->box;
  const Image<std::uint16_t>& ids = loaded.instance_ids;
  auto image = std::make_shared<Image<std::uint16_t>>(ids.width, ids.height);
  const std::optional<Rle> rle = rle_from_string(label.amodal->rle, rect.width, rect.height);
  PixelRect box;
  std::int64_t area = 0;
  for_each_stretch(*rle, [&](int stretch_column, int first, int end) {
    const int column = rect.x + stretch_column;
    const int top = std::max(rect.y + first, 0);
    const int below = std::min(rect.y + end, ids.height);
    if (column < 0 || column >= ids.width || top >= below) return;
    for (int row = top; row < below; ++row) image->at(row, column) = 1;
    area += below - top;
    box = union_of(box, {column, top, 1, below - top});
  });
  const Mask mask(*image, 1, box);
  return ExportInstance{&label, mask, area, std::move(image)};
}

Counts count_instances(const ExportFrame& frame) {
  return count_instances(frame, [](const InstanceLabel&) { return true; });
}

Counts count_instances(const ExportFrame& frame,
                       const std::function<bool(const InstanceLabel&)>& asked_for) {
  Counts counts{};
  for (const ExportInstance& instance : frame.instances) {
    at(counts, Count::kAnnotations) += asked_for(*instance.label);
  }
  for (const ExportFrame::LeftOut& left_out : frame.left_out) {
    at(counts, left_out.why) += asked_for(*left_out.label);
  }
  return counts;
}

Result<std::unique_ptr<ExportFrame>> select_instances(const CommittedFrame& frame,
                                                      LoadedFrame loaded, std::string split,
                                                      const ExportOptions& options) {
  auto selected = std::make_unique<ExportFrame>();
  selected->frame = frame;
  selected->loaded = std::move(loaded);
  selected->split = std::move(split);
  selected->stem = frame_stem(frame.index);
  for (const InstanceLabel& label : selected->loaded.labels.instances) {
    if (label.category == 0 || label.area_px == 0) continue;
    if (label.area_px < options.min_pixels) {
      selected->left_out.push_back({&label, Count::kTooSmall});
    } else if (label.amodal && label.visible_fraction() < options.min_visible) {
      selected->left_out.push_back({&label, Count::kTooHidden});
    } else if (options.amodal) {
      auto whole = whole_instance(frame, selected->loaded, label);
      if (!whole) return forward_error(whole);
      selected->instances.push_back(std::move(*whole));
    } else {
      const Mask mask(selected->loaded.instance_ids, label.id, label.box);
      selected->instances.push_back({&label, mask, label.area_px, nullptr});
    }
  }
  return selected;
}

}  // namespace seedframe
