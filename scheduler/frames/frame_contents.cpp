#include "frames/frame_contents.h"

#include <algorithm>
#include <array>

#include "annotate/amodal.h"
#include "annotate/labels.h"
#include "base/canonical_writer.h"
#include "base/files.h"
#include "frames/campaign_files.h"
#include "frames/frame_image.h"
#include "image/crop.h"
#include "image/exr_file.h"
#include "image/pass_reader.h"
#include "image/pixel_hash.h"
#include "image/png_file.h"
#include "plan/pass_plan.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// Without what depends on how rays are traced.
Json without_silhouettes(Json labels) {
  for (Json& instance : labels["instances"]) {
    for (const char* key : {"amodal", "visible_fraction", "truncation", "keypoints"}) {
      instance.erase(key);
    }
  }
  return labels;
}

class Contents {
 public:
  Contents(const fs::path& folder, const Manifest& manifest, const FrameSpec& spec,
           const ContentWish& wish, TwinTracer& tracer)
      : folder_(folder), manifest_(manifest), spec_(spec), wish_(wish), tracer_(tracer) {}

  std::vector<std::string> complaints() {
    if (text_of(frame_files::kSpec) != readable_layout(canonical_text(spec_))) {
      complain(frame_files::kSpec, "is not the spec of its frame");
    }
    const Result<Image<std::uint16_t>> ids = read_png16(folder_ / frame_files::kInstances);
    if (!ids) {
      complaints_.push_back(ids.error().message);
    } else if (ids->width != spec_.render.width || ids->height != spec_.render.height) {
      complain(frame_files::kInstances, "has another size than the spec says");
    } else {
      check_hash(frame_files::kInstances, "index", pixel_hash(hashed_part(*ids), "X"));
      check_labels(*ids);
    }
    if (manifest_.files.contains(frame_files::kPasses)) check_passes();
    check_picture();
    check_data_pass(frame_files::kDepth, "depth", {"Z"});
    check_data_pass(frame_files::kNormal, "normal", {"X", "Y", "Z"});
    name_strange_files();
    return std::move(complaints_);
  }

 private:
  void complain(const std::string& file, const std::string& what) {
    complaints_.push_back(file + " " + what);
  }

  /// Empty for a file that cannot be read.
  std::string text_of(const char* file) const {
    return read_file(folder_ / file).value_or(std::string());
  }

  void check_hash(const std::string& file, const std::string& pass, const std::string& hash) {
    const auto found = manifest_.pixel_hashes.find(pass);
    if (found != manifest_.pixel_hashes.end() && found->second == hash) return;
    complain(file, "has other pixels than were hashed when they were made");
  }

  /// Hashes are of the pixels that were rendered; the twin alone makes whole images.
  template <class T>
  Image<T> hashed_part(const Image<T>& image) const {
    const bool rendered = manifest_.files.contains(frame_files::kPasses);
    return rendered && spec_.render.region ? cropped(image, *spec_.render.region) : image;
  }

  void check_labels(const Image<std::uint16_t>& ids) {
    const Result<Image<std::uint8_t>> semantic = read_png8(folder_ / frame_files::kSemantic);
    if (!semantic || semantic->values != semantic_image(spec_, ids).values) {
      complain(frame_files::kSemantic, "does not follow from instances.png");
    }
    Result<FrameLabels> labels = make_labels(spec_, wish_.categories, ids);
    if (!labels) {
      complain(frame_files::kInstances, labels.error().message);
      return;
    }
    if (wish_.meshes == nullptr) return;
    const Result<Twin> twin = tracer_.trace(spec_, *wish_.meshes, TwinTracer::Passes::kIdsOnly);
    if (!twin) {
      complaints_.push_back(twin.error().message);
      return;
    }
    add_amodal_labels(*labels, spec_, *twin, ids);
    const std::string made = readable_layout(canonical_text(*labels));
    const std::string stored = text_of(frame_files::kLabels);
    if (made == stored) return;
    const auto json = parse_json(stored, frame_files::kLabels);
    const bool same = !wish_.same_rays && json && json->contains("instances") &&
                      without_silhouettes(*json) == without_silhouettes(to_json(*labels));
    if (!same) complain(frame_files::kLabels, "does not follow from instances.png and the spec");
  }

  void check_passes() {
    const PassPlan plan = plan_passes(spec_);
    PassExpectation expected;
    const PixelRect pixels = spec_.render.rendered_pixels();
    expected.width = pixels.width;
    expected.height = pixels.height;
    expected.depth = plan.depth;
    expected.normal = plan.normal;
    expected.max_instance_id = kLargestImageId;
    const Result<FramePasses> passes = read_passes(folder_ / frame_files::kPasses, expected);
    if (!passes) {
      complaints_.push_back(passes.error().message);
      return;
    }
    for (const auto& [pass, hash] : passes->pixel_hashes) {
      // A lens disturbs the others, which come from a rendering that is not kept.
      if (pass == "combined" || !plan.sharp_rendering) check_hash(frame_files::kPasses, pass, hash);
    }
  }

  void check_picture() {
    const std::string file = manifest_.image_file();
    if (!manifest_.files.contains(file) || is_lossy(manifest_.image)) return;
    const auto image = read_frame_image(folder_, manifest_.image.format);
    if (!image) {
      complaints_.push_back(image.error().message);
    } else {
      check_hash(file, "image", pixel_hash(*image, "R,G,B"));
    }
  }

  void check_data_pass(const char* file, const char* pass,
                       const std::vector<std::string>& channels) {
    if (!manifest_.files.contains(file)) return;
    Image<float> image(spec_.render.width, spec_.render.height, static_cast<int>(channels.size()));
    std::string names;
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
      const Result<Image<float>> plane = read_exr_channel(folder_ / file, channels[channel]);
      if (!plane || plane->width != image.width || plane->height != image.height) {
        complain(file, plane ? "has another size than the spec says" : "cannot be read");
        return;
      }
      for (std::size_t i = 0; i < plane->values.size(); ++i) {
        image.values[i * channels.size() + channel] = plane->values[i];
      }
      names += (names.empty() ? "" : ",") + channels[channel];
    }
    check_hash(file, pass, pixel_hash(hashed_part(image), "float", names));
  }

  void name_strange_files() {
    std::error_code error;
    std::vector<std::string> strange;
    for (const auto& entry : fs::directory_iterator(folder_, error)) {
      const std::string name = entry.path().filename().string();
      if (name != frame_files::kManifest && !manifest_.files.contains(name)) {
        strange.push_back(name);
      }
    }
    std::sort(strange.begin(), strange.end());
    for (const std::string& name : strange) complain(name, "is not one of the frame's files");
  }

  const fs::path& folder_;
  const Manifest& manifest_;
  const FrameSpec& spec_;
  const ContentWish& wish_;
  TwinTracer& tracer_;
  std::vector<std::string> complaints_;
};

}  // namespace

std::vector<std::string> wrong_contents(const fs::path& folder, const Manifest& manifest,
                                        const FrameSpec& spec, const ContentWish& wish,
                                        TwinTracer& tracer) {
  return Contents(folder, manifest, spec, wish, tracer).complaints();
}

}  // namespace seedframe
