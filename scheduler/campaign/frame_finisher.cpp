#include "campaign/frame_finisher.h"

#include <algorithm>

#include "annotate/labels.h"
#include "base/campaign_files.h"
#include "base/files.h"
#include "base/sha256.h"
#include "campaign/manifest.h"
#include "image/exr_file.h"
#include "image/exr_metadata.h"
#include "image/pass_reader.h"
#include "image/pixel_hash.h"
#include "image/png_file.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRenderedPasses = "rendered.exr";
constexpr const char* kSharpPasses = "rendered.exr.sharp";

/// Writes the files of one frame and keeps account of them for the manifest.
class FrameWriter {
 public:
  explicit FrameWriter(fs::path folder) : folder_(std::move(folder)) {}

  void write(const char* name, const std::string& bytes) {
    if (!status_) return;
    status_ = write_file_unsynced(folder_ / name, bytes);
    manifest_.files[name] = {bytes.size(), sha256_hex(bytes)};
  }

  /// For what `make` writes itself.
  template <class Make>
  void make(const char* name, Make make) {
    if (!status_) return;
    const fs::path path = folder_ / name;
    status_ = make(path);
    if (!status_) return;
    const Result<std::string> sha256 = sha256_of_file(path);
    if (!sha256) {
      status_ = forward_error(sha256);
      return;
    }
    std::error_code error;
    manifest_.files[name] = {fs::file_size(path, error), *sha256};
  }

  Manifest& manifest() { return manifest_; }
  const Status& status() const { return status_; }

 private:
  fs::path folder_;
  Manifest manifest_;
  Status status_;
};

PassExpectation expectation(const FrameSpec& spec) {
  PassExpectation expected;
  expected.width = spec.render.width;
  expected.height = spec.render.height;
  expected.depth = spec.render.depth;
  expected.normal = spec.render.normal;
  for (const InstanceSpec& instance : spec.instances) {
    expected.max_instance_id = std::max(expected.max_instance_id, instance.id);
  }
  return expected;
}

/// The passes of a frame. Depth of field disturbs all but the picture, so then the worker renders
/// the rest once more without it.
Result<FramePasses> read_frame_passes(const FinishTask& task) {
  const PassExpectation expected = expectation(task.spec);
  Result<FramePasses> passes = read_passes(rendered_passes(task.attempt_folder), expected);
  if (!passes || task.spec.camera.aperture_radius_m == 0.0) return passes;
  const fs::path path = task.attempt_folder / kSharpPasses;
  Result<FramePasses> sharp = read_passes(path, expected);
  if (!sharp) return sharp;
  sharp->combined = std::move(passes->combined);
  sharp->pixel_hashes["combined"] = passes->pixel_hashes["combined"];
  std::error_code ignored;
  fs::remove(path, ignored);
  return sharp;
}

void write_passes(const fs::path& rendered, const FramePasses& passes, FrameWriter& writer) {
  writer.make(frame_files::kPasses,
              [&](const fs::path& path) { return copy_without_metadata(rendered, path); });
  if (passes.depth) {
    writer.make(frame_files::kDepth,
                [&](const fs::path& path) { return write_exr(path, *passes.depth, {"Z"}); });
  }
  if (passes.normal) {
    writer.make(frame_files::kNormal, [&](const fs::path& path) {
      return write_exr(path, *passes.normal, {"X", "Y", "Z"});
    });
  }
}

}  // namespace

fs::path rendered_passes(const fs::path& attempt_folder) {
  return attempt_folder / kRenderedPasses;
}

Result<std::string> finish_frame(const FinishTask& task, const ColorManagement& color) {
  const fs::path rendered = rendered_passes(task.attempt_folder);
  const Result<FramePasses> passes = read_frame_passes(task);
  if (!passes) return forward_error(passes);
  const Result<FrameLabels> labels = make_labels(task.spec, passes->instance_ids);
  if (!labels) return forward_error(labels);
  const ImageSettings& view = task.spec.image;
  const auto image = color.apply(
      passes->combined, {view.display, view.view, view.look, view.exposure_stops, view.gamma});
  if (!image) return forward_error(image);

  FrameWriter writer(task.attempt_folder);
  writer.write(frame_files::kSpec, readable_json(to_json(task.spec)));
  writer.write(frame_files::kImage, encode_png(*image));
  writer.write(frame_files::kInstances, encode_png(passes->instance_ids));
  writer.write(frame_files::kSemantic, encode_png(semantic_image(task.spec, passes->instance_ids)));
  writer.write(frame_files::kLabels, readable_json(to_json(*labels)));
  write_passes(rendered, *passes, writer);
  Manifest& manifest = writer.manifest();
  manifest.frame_id = task.frame_id;
  manifest.pixel_hashes = passes->pixel_hashes;
  manifest.pixel_hashes["image"] = pixel_hash(*image, "R,G,B");
  const std::string manifest_text = readable_json(to_json(manifest));
  const std::string hash = manifest.pixel_hash();
  if (!writer.status()) return forward_error(writer.status());
  if (Status written =
          write_file_unsynced(task.attempt_folder / frame_files::kManifest, manifest_text);
      !written) {
    return forward_error(written);
  }
  std::error_code ignored;
  fs::remove(rendered, ignored);
  return hash;
}

}  // namespace seedframe
