#include "page/frame_digest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/files.h"
#include "frames/campaign_files.h"

namespace seedframe {
namespace {

template <class T>
T held(std::int64_t value) {
  constexpr auto kMost = static_cast<std::int64_t>(std::numeric_limits<T>::max());
  return static_cast<T>(std::clamp<std::int64_t>(value, 0, kMost));
}

std::uint16_t permille(double share) {
  return held<std::uint16_t>(std::llround(1000.0 * std::clamp(share, 0.0, 1.0)));
}

}  // namespace

Result<FrameLabels> stored_labels(const CommittedFrame& frame) {
  const std::filesystem::path file = frame.folder / frame_files::kLabels;
  const Result<std::string> text = read_file(file);
  if (!text) return forward_error(text);
  const Result<Json> json = parse_json(*text, file.string());
  if (!json) return forward_error(json);
  return labels_from_json(*json, file.string());
}

FrameDigest digest_frame(const CommittedFrame& frame, const std::vector<std::string>& categories,
                         bool has_pictures, ThumbnailSize size) {
  FrameDigest digest;
  const Result<FrameReader> reader = FrameReader::open(frame, {.image_pixels = has_pictures});
  if (!reader) {
    digest.damage = reader.error().message;
    return digest;
  }
  Result<LoadedFrame> loaded = reader->load(categories);
  if (!loaded) {
    digest.damage = loaded.error().message;
    return digest;
  }
  digest.objects = std::move(loaded->labels.instances);
  std::vector<int> ids;
  for (const InstanceLabel& object : digest.objects) ids.push_back(object.id);
  digest.mask = reduced_mask(loaded->instance_ids, ids, size);
  if (loaded->image) {
    digest.picture = reduced(*loaded->image, size);
    digest.signature = signature_of(*digest.picture);
  }
  return digest;
}

void add_objects(const FrameDigest& digest, FrameTable& table) {
  ObjectColumns& columns = table.objects;
  for (const InstanceLabel& object : digest.objects) {
    columns.id.push_back(held<std::uint16_t>(object.id));
    columns.category.push_back(held<std::uint16_t>(object.category));
    columns.asset.push_back(held<std::uint16_t>(table.assets.place_of(object.asset)));
    columns.name.push_back(table.names.place_of(object.name));
    columns.x.push_back(held<std::uint16_t>(object.box.x));
    columns.y.push_back(held<std::uint16_t>(object.box.y));
    columns.width.push_back(held<std::uint16_t>(object.box.width));
    columns.height.push_back(held<std::uint16_t>(object.box.height));
    columns.area_px.push_back(held<std::uint32_t>(object.area_px));
    const bool known = object.amodal.has_value();
    columns.visible_permille.push_back(known ? permille(object.visible_fraction())
                                             : ObjectColumns::kUnknown);
    columns.truncation_permille.push_back(known ? permille(object.truncation())
                                                : ObjectColumns::kUnknown);
    columns.distance_m.push_back(known
                                     ? static_cast<float>(object.amodal->pose.translation_m.norm())
                                     : std::numeric_limits<float>::quiet_NaN());
  }
}

}  // namespace seedframe
