#include "audit/frame_difference.h"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "base/files.h"
#include "frames/campaign_files.h"
#include "frames/frame_image.h"
#include "frames/rendered_frame.h"
#include "image/pass_reader.h"
#include "image/png_file.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kAnyInstanceId = 32767;
constexpr double kWhite = 255.0;  // in code values

struct FramePixels {
  std::optional<FramePasses> passes;  ///< of a rendered frame
  std::optional<Image<std::uint8_t>> image;
  Image<std::uint16_t> instance_ids;
};

/// `manifest` of a frame whose picture is wanted too, else null.
Result<FramePixels> read_pixels(const fs::path& folder, const Manifest* manifest) {
  FramePixels pixels;
  Result<Image<std::uint16_t>> ids = read_png16(folder / frame_files::kInstances);
  if (!ids) return forward_error(ids);
  pixels.instance_ids = std::move(*ids);
  std::error_code error;
  if (!fs::exists(folder / frame_files::kPasses, error)) return pixels;  // labels by geometry
  const Result<PixelRect> rendered = rendered_pixels_of(folder);
  if (!rendered) return forward_error(rendered);
  PassExpectation expected{rendered->width, rendered->height};
  expected.depth = fs::exists(folder / frame_files::kDepth, error);
  expected.normal = fs::exists(folder / frame_files::kNormal, error);
  expected.max_instance_id = kAnyInstanceId;
  Result<FramePasses> passes = read_passes(folder / frame_files::kPasses, expected);
  if (!passes) {  // it was good when it was written
    return fail(ErrorKind::kCorrupt, "{}", passes.error().message);
  }
  pixels.passes = std::move(*passes);
  if (manifest == nullptr) return pixels;
  Result<Image<std::uint8_t>> image = read_frame_image(folder, manifest->image.format);
  if (!image) return forward_error(image);
  pixels.image = std::move(*image);
  return pixels;
}

template <class T>
bool alike(const Image<T>& a, const Image<T>& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels;
}

void compare_rendered(const FramePixels& a, const FramePixels& b,
                      const std::set<std::string>& which, FrameDifference& difference) {
  auto& passes = difference.passes;
  const FramePasses& x = *a.passes;
  const FramePasses& y = *b.passes;
  if (which.contains("combined")) {
    passes["combined"] = difference_of(x.combined, y.combined, StoredAs::kHalf);
  }
  if (which.contains("depth") && x.depth && y.depth) {
    passes["depth"] = difference_of(*x.depth, *y.depth, StoredAs::kFloat);
  }
  if (which.contains("normal") && x.normal && y.normal) {
    passes["normal"] = difference_of(*x.normal, *y.normal, StoredAs::kFloat);
  }
  if (a.image && b.image && alike(*a.image, *b.image)) {
    passes["image"] = difference_of(*a.image, *b.image);
  }
}

/// Passes with other hashes, or that one manifest lacks.
std::set<std::string> differing_passes(const Manifest& a, const Manifest& b,
                                       FrameDifference& difference) {
  std::set<std::string> names;
  for (const auto* manifest : {&a, &b}) {
    for (const auto& [pass, hash] : manifest->pixel_hashes) names.insert(pass);
  }
  std::set<std::string> differing;
  for (const std::string& pass : names) {
    const auto x = a.pixel_hashes.find(pass);
    const auto y = b.pixel_hashes.find(pass);
    if (x == a.pixel_hashes.end() || y == b.pixel_hashes.end()) {
      difference.unlike = fmt::format("only one has the pass {}", pass);
    } else if (x->second != y->second) {
      differing.insert(pass);
    }
  }
  return differing;
}

bool other_labels(const Manifest& a, const Manifest& b) {
  const auto x = a.files.find(frame_files::kLabels);
  const auto y = b.files.find(frame_files::kLabels);
  if (x == a.files.end() || y == b.files.end()) return x != a.files.end() || y != b.files.end();
  return x->second.sha256 != y->second.sha256;
}

Grade grade_of(const FrameDifference& difference, const std::set<std::string>& differing,
               const Tolerance& tolerance) {
  if (!difference.unlike.empty()) return Grade::kNotReproducible;
  if (differing.contains("index") || difference.labels_json) return Grade::kLabels;
  const auto combined = difference.passes.find("combined");
  if (combined != difference.passes.end()) return grade_of_colors(combined->second, tolerance);
  // Depth and normals without the picture, or 8 bits of the same picture: a little thing.
  return differing.empty() ? Grade::kIdentical : Grade::kTolerance;
}

}  // namespace

Result<FrameDifference> difference_of_frames(const fs::path& expected,
                                             const Manifest& expected_manifest,
                                             const fs::path& found, const Manifest& found_manifest,
                                             const Tolerance& tolerance) {
  FrameDifference difference;
  difference.labels_json = other_labels(expected_manifest, found_manifest);
  const std::set<std::string> which =
      differing_passes(expected_manifest, found_manifest, difference);
  if (!which.empty()) {
    const bool pictures = which.contains("image");
    const Result<FramePixels> a = read_pixels(expected, pictures ? &expected_manifest : nullptr);
    if (!a) return forward_error(a);
    const Result<FramePixels> b = read_pixels(found, pictures ? &found_manifest : nullptr);
    if (!b) return forward_error(b);
    if (!alike(a->instance_ids, b->instance_ids)) {
      difference.unlike =
          fmt::format("{} × {} pixels, here {} × {}", a->instance_ids.width, a->instance_ids.height,
                      b->instance_ids.width, b->instance_ids.height);
    } else {
      if (which.contains("index")) {
        difference.passes["index"] = difference_of(a->instance_ids, b->instance_ids);
      }
      if (a->passes && b->passes && alike(a->passes->combined, b->passes->combined)) {
        compare_rendered(*a, *b, which, difference);
      } else if (a->passes && b->passes) {
        difference.unlike = "other parts of the image were rendered";
      }
    }
  }
  difference.grade = grade_of(difference, which, tolerance);
  return difference;
}

std::string describe(const FrameDifference& difference) {
  std::vector<std::string> parts;
  if (!difference.unlike.empty()) parts.push_back(difference.unlike);
  for (const auto& [pass, each] : difference.passes) {
    std::string text = fmt::format("{} {} of {} pixels", pass, each.differing, each.pixels);
    if (pass == "image") {
      text += fmt::format(", at most {} of 255, RMS {:.2g}, PSNR {:.1f} dB", each.max, each.rms,
                          each.psnr_db(kWhite));
    } else if (pass == "normal") {  // near zero, units in the last place say nothing
      text += fmt::format(", at most {:.2g}, RMS {:.2g}", each.max, each.rms);
    } else if (pass != "index") {
      text += fmt::format(", at most {:.2g} or {} units in the last place, RMS {:.2g}", each.max,
                          each.max_ulp, each.rms);
      if (pass == "combined") text += fmt::format(", PSNR {:.1f} dB", each.psnr_db(1.0));
    }
    parts.push_back(std::move(text));
  }
  if (difference.labels_json) parts.emplace_back("labels.json differs");
  return fmt::format("{}", fmt::join(parts, "; "));
}

Json to_json(const FrameDifference& difference) {
  Json passes = Json::object();
  for (const auto& [pass, each] : difference.passes) {
    passes[pass] = {{"pixels", each.pixels}, {"differing", each.differing}};
    if (pass == "index") continue;
    // Beyond all numbers where a NaN is: JSON has none.
    passes[pass]["max"] = std::min(each.max, 1e308);
    passes[pass]["rms"] = std::min(each.rms, 1e308);
    passes[pass]["max_ulp"] = each.max_ulp;
    if (pass == "combined" || pass == "image") {
      passes[pass]["psnr_db"] =
          std::clamp(each.psnr_db(pass == "image" ? kWhite : 1.0), -1e308, 1e308);
    }
  }
  return {{"grade", to_string(difference.grade)},
          {"passes", passes},
          {"labels_json", difference.labels_json},
          {"unlike", difference.unlike}};
}

Result<Image<std::uint8_t>> heat_map_of_frames(const fs::path& expected, const fs::path& found) {
  const Result<FramePixels> a = read_pixels(expected, nullptr);
  if (!a) return forward_error(a);
  const Result<FramePixels> b = read_pixels(found, nullptr);
  if (!b) return forward_error(b);
  if (!a->passes || !b->passes || !alike(a->passes->combined, b->passes->combined)) {
    return fail(ErrorKind::kInput, "{} and {} have no pictures of the same size", expected.string(),
                found.string());
  }
  return heat_map(a->passes->combined, b->passes->combined);
}

}  // namespace seedframe
