#include "export/dataset.h"

#include <unordered_map>

#include "annotate/extents.h"
#include "base/campaign_files.h"
#include "base/files.h"
#include "image/png_file.h"

namespace seedframe {
namespace {

constexpr const char* kRemedy = "run 'seedframe resume' to render the frame again";

using ExtentsById = std::unordered_map<int, InstanceExtent>;

Status check_label(const Dataset& dataset, const DatasetFrame& frame, const InstanceLabel& label,
                   const InstanceExtent& pixels) {
  const std::string where =
      fmt::format("frame {}, instance {} ('{}')", frame.index, label.id, label.name);
  if (label.category > static_cast<int>(dataset.categories.size())) {
    return fail(ErrorKind::kCorrupt, "{}: labels.json says category {}, the campaign has {}", where,
                label.category, dataset.categories.size());
  }
  if (label.area_px != pixels.area_px) {
    return fail(ErrorKind::kCorrupt, "{}: labels.json says {} pixels, instances.png has {}; {}",
                where, label.area_px, pixels.area_px, kRemedy);
  }
  if (label.box != pixels.box) {
    const PixelBox& said = label.box;
    const PixelBox& found = pixels.box;
    return fail(
        ErrorKind::kCorrupt,
        "{}: labels.json says the box [{}, {}, {}, {}], instances.png has [{}, {}, {}, {}]; "
        "{}",
        where, said.x, said.y, said.width, said.height, found.x, found.y, found.width, found.height,
        kRemedy);
  }
  return {};
}

Status check_agreement(const Dataset& dataset, const DatasetFrame& frame,
                       const LoadedFrame& loaded) {
  const Image<std::uint16_t>& ids = loaded.instance_ids;
  const FrameLabels& labels = loaded.labels;
  if (ids.width != labels.width || ids.height != labels.height) {
    return fail(ErrorKind::kCorrupt, "frame {}: labels.json says {}x{}, instances.png is {}x{}; {}",
                frame.index, labels.width, labels.height, ids.width, ids.height, kRemedy);
  }
  ExtentsById extents;
  for (const InstanceExtent& extent : measure_extents(ids)) extents.emplace(extent.id, extent);
  for (const InstanceLabel& label : labels.instances) {
    const auto found = extents.find(label.id);
    const InstanceExtent pixels = found == extents.end() ? InstanceExtent{} : found->second;
    if (Status same = check_label(dataset, frame, label, pixels); !same) return same;
    if (found != extents.end()) extents.erase(found);
  }
  if (!extents.empty()) {
    int least = extents.begin()->first;
    for (const auto& [id, extent] : extents) least = std::min(least, id);
    return fail(ErrorKind::kCorrupt,
                "frame {}, instance {}: instances.png has {} pixels of it, labels.json does not "
                "know it; {}",
                frame.index, least, extents.at(least).area_px, kRemedy);
  }
  return {};
}

/// The same error, with the frame named in front.
template <class T>
tl::unexpected<Error> in_frame(const DatasetFrame& frame, const Result<T>& result) {
  return fail(result.error().kind, "frame {}: {}", frame.index, result.error().message);
}

}  // namespace

Result<LoadedFrame> load_frame(const Dataset& dataset, const DatasetFrame& frame) {
  const std::filesystem::path labels_path = frame.folder / frame_files::kLabels;
  const auto text = read_file(labels_path);
  if (!text) return in_frame(frame, text);
  const auto json = parse_json(*text, labels_path.string());
  if (!json) return in_frame(frame, json);
  auto labels = labels_from_json(*json, labels_path.string());
  if (!labels) return in_frame(frame, labels);
  auto ids = read_png16(frame.folder / frame_files::kInstances);
  if (!ids) return in_frame(frame, ids);
  LoadedFrame loaded{std::move(*labels), std::move(*ids)};
  if (Status agree = check_agreement(dataset, frame, loaded); !agree) return forward_error(agree);
  return loaded;
}

}  // namespace seedframe
