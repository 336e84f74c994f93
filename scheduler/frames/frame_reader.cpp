#include "frames/frame_reader.h"

#include <algorithm>
#include <unordered_map>

#include "annotate/extents.h"
#include "base/files.h"
#include "base/sha256.h"
#include "frames/campaign_files.h"
#include "frames/frame_image.h"
#include "image/exr_file.h"
#include "image/png_file.h"
#include "spec/frame_spec_reader.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRemedy = "'seedframe resume --verify' renders the frame again";
constexpr std::size_t kKeyDigits = 32;

using ExtentsById = std::unordered_map<int, InstanceExtent>;

Status check_label(const CommittedFrame& frame, const InstanceLabel& label,
                   const InstanceExtent& pixels) {
  const auto complain = [&](const std::string& said, const std::string& found) {
    return fail(ErrorKind::kCorrupt,
                "frame {}, instance {} ('{}'): labels.json says {}, instances.png has {}; {}",
                frame.index, label.id, label.name, said, found, kRemedy);
  };
  if (label.area_px != pixels.area_px) {
    return complain(fmt::format("{} pixels", label.area_px), fmt::format("{}", pixels.area_px));
  }
  if (label.box != pixels.box) {
    const auto text = [](const PixelRect& box) {
      return fmt::format("[{}, {}, {}, {}]", box.x, box.y, box.width, box.height);
    };
    return complain("the box " + text(label.box), text(pixels.box));
  }
  return {};
}

Status check_categories(const std::vector<std::string>& now, const CommittedFrame& frame,
                        const FrameLabels& labels) {
  if (labels.categories == now) return {};
  for (const std::string& category : labels.categories) {
    if (std::find(now.begin(), now.end(), category) != now.end()) continue;
    return fail(ErrorKind::kCorrupt,
                "frame {} was labelled with a class '{}', which the campaign's config no longer "
                "has: put it back into 'categories', or submit the campaign again",
                frame.index, category);
  }
  return fail(ErrorKind::kCorrupt,
              "frame {} was labelled with {} classes, the campaign's config has {} or another "
              "order of them: make 'categories' as they were, or submit the campaign again",
              frame.index, labels.categories.size(), now.size());
}

Status check_agreement(const CommittedFrame& frame, const LoadedFrame& loaded) {
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
    if (Status same = check_label(frame, label, pixels); !same) return same;
    if (found != extents.end()) extents.erase(found);
  }
  if (extents.empty()) return {};
  const auto least =
      std::min_element(extents.begin(), extents.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
  return fail(ErrorKind::kCorrupt,
              "frame {}, instance {}: instances.png has {} pixels of it, labels.json does not "
              "know it; {}",
              frame.index, least->first, least->second.area_px, kRemedy);
}

/// The same error, with the frame named in front.
template <class T>
tl::unexpected<Error> in_frame(const CommittedFrame& frame, const Result<T>& result) {
  return fail(ErrorKind::kCorrupt, "frame {}: {}", frame.index, result.error().message);
}

Status check_hash(const CommittedFrame& frame, const std::string& name, const Manifest& manifest,
                  const std::string& sha256) {
  const auto file = manifest.files.find(name);
  if (file != manifest.files.end() && file->second.sha256 == sha256) return {};
  return fail(
      ErrorKind::kCorrupt, "frame {}: {} {}; {}", frame.index, (frame.folder / name).string(),
      file == manifest.files.end() ? "is not in the frame's manifest" : "has changed", kRemedy);
}

Result<std::string> read_checked(const CommittedFrame& frame, const char* name,
                                 const Manifest& manifest) {
  auto bytes = read_file(frame.folder / name);
  if (!bytes) {
    return fail(ErrorKind::kCorrupt, "frame {}: {}; {}", frame.index, bytes.error().message,
                kRemedy);
  }
  const Status same = check_hash(frame, name, manifest, sha256_hex(*bytes));
  if (!same) return forward_error(same);
  return bytes;
}

Status check_file(const CommittedFrame& frame, const std::string& name, const Manifest& manifest) {
  const auto sha256 = sha256_of_file(frame.folder / name);
  if (!sha256) {
    return fail(ErrorKind::kCorrupt, "frame {}: {}; {}", frame.index, sha256.error().message,
                kRemedy);
  }
  return check_hash(frame, name, manifest, *sha256);
}

Result<Image<float>> read_normals(const fs::path& path) {
  Image<float> normal;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto plane = read_exr_channel(path, std::string(1, "XYZ"[channel]));
    if (!plane) return forward_error(plane);
    if (channel == 0) normal = Image<float>(plane->width, plane->height, 3);
    for (std::size_t i = 0; i < plane->values.size(); ++i) {
      normal.values[3 * i + channel] = plane->values[i];
    }
  }
  return normal;
}

}  // namespace

Result<FrameSpec> stored_spec(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / frame_files::kSpec;
  const Result<std::string> text = read_file(path);
  if (!text) return forward_error(text);
  const Result<Json> json = parse_json(*text, path.string());
  if (!json) return forward_error(json);
  return frame_spec_from_json(*json, path.string());
}

Result<FrameReader> FrameReader::open(const CommittedFrame& frame, const FrameParts& parts) {
  FrameReader reader;
  reader.frame_ = frame;
  reader.parts_ = parts;
  auto manifest = verify_frame(frame.folder, frame.frame_id, VerifyDepth::kSizes);
  if (!manifest) {
    return fail(ErrorKind::kCorrupt, "frame {}: {}; {}", frame.index, manifest.error().message,
                kRemedy);
  }
  reader.manifest_ = std::move(*manifest);
  reader.key_ =
      sha256_hex(fmt::format("{}\n{}", frame.scene, canonical_json(to_json(reader.manifest_))))
          .substr(0, kKeyDigits);
  auto labels = read_checked(frame, frame_files::kLabels, reader.manifest_);
  if (!labels) return forward_error(labels);
  reader.labels_ = std::move(*labels);
  auto instances = read_checked(frame, frame_files::kInstances, reader.manifest_);
  if (!instances) return forward_error(instances);
  reader.instances_ = std::move(*instances);
  if (parts.image_file || parts.image_pixels) {
    const Status image = check_file(frame, reader.image_file(), reader.manifest_);
    if (!image) return forward_error(image);
  }
  if (parts.depth) {
    const Status depth = check_file(frame, frame_files::kDepth, reader.manifest_);
    if (!depth) return forward_error(depth);
  }
  reader.parts_.normal = parts.normal && reader.manifest_.files.contains(frame_files::kNormal);
  if (reader.parts_.normal) {
    const Status normal = check_file(frame, frame_files::kNormal, reader.manifest_);
    if (!normal) return forward_error(normal);
  }
  return reader;
}

std::string FrameReader::sha256(const std::string& name) const {
  const auto found = manifest_.files.find(name);
  return found == manifest_.files.end() ? std::string() : found->second.sha256;
}

Result<LoadedFrame> FrameReader::load(const std::vector<std::string>& categories) const {
  const std::string labels_path = (frame_.folder / frame_files::kLabels).string();
  const auto json = parse_json(labels_, labels_path);
  if (!json) return in_frame(frame_, json);
  auto labels = labels_from_json(*json, labels_path);
  if (!labels) return in_frame(frame_, labels);
  auto ids = decode_png16(instances_, (frame_.folder / frame_files::kInstances).string());
  if (!ids) return in_frame(frame_, ids);
  LoadedFrame loaded{std::move(*labels), std::move(*ids), {}, {}};
  loaded.image_file = image_file();
  loaded.image_sha256 = sha256(loaded.image_file);
  if (Status known = check_categories(categories, frame_, loaded.labels); !known) {
    return forward_error(known);
  }
  if (Status agree = check_agreement(frame_, loaded); !agree) return forward_error(agree);
  if (parts_.image_pixels) {
    auto image = read_frame_image(frame_.folder, manifest_.image.format);
    if (!image && image.error().kind != ErrorKind::kCorrupt) return forward_error(image);
    if (!image) return in_frame(frame_, image);
    loaded.image = std::move(*image);
  }
  if (parts_.depth) {
    auto depth = read_exr_channel(frame_.folder / frame_files::kDepth, "Z");
    if (!depth) return in_frame(frame_, depth);
    loaded.depth = std::move(*depth);
  }
  if (parts_.normal) {
    auto normal = read_normals(frame_.folder / frame_files::kNormal);
    if (!normal) return in_frame(frame_, normal);
    loaded.normal = std::move(*normal);
  }
  return loaded;
}

}  // namespace seedframe
