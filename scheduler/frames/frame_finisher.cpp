#include "frames/frame_finisher.h"

#include "annotate/amodal.h"
#include "annotate/labels.h"
#include "base/canonical_writer.h"
#include "frames/campaign_files.h"
#include "frames/frame_writer.h"
#include "frames/rendered_frame.h"
#include "image/exr_file.h"
#include "image/exr_metadata.h"
#include "image/pixel_hash.h"
#include "image/png_file.h"
#include "image_files/image_writer.h"
#include "sensor/camera_sensor.h"
#include "twin/twin_comparison.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// Moves what was rendered out of the attempt's folder, which goes, and puts beside it what it
/// should have been.
Status keep_rejected(const FinishTask& task, const Image<std::uint16_t>& rendered, const Twin& twin,
                     const std::string& reason) {
  const fs::path& folder = task.rejected_folder;
  std::error_code error;
  fs::remove_all(folder, error);
  if (Status made = make_folders(folder); !made) return made;
  const fs::path written = rendered_passes(task.attempt_folder);
  for (const fs::path& file : {written, sharp_passes(written)}) {
    fs::rename(file, folder / file.filename(), error);  // the sharp one is seldom there
  }
  FrameWriter writer(folder);
  writer.write(frame_files::kSpec, readable_layout(canonical_text(task.spec)));
  writer.write(frame_files::kInstances, encode_png(rendered));
  writer.write(frame_files::kTwin, encode_png(twin.instance_ids));
  writer.write(frame_files::kDifference,
               encode_png(difference_image(rendered, twin.instance_ids, rounding_of(twin))));
  writer.write(frame_files::kReason, reason + "\n");
  return writer.status();
}

Result<TwinTally> check_with_twin(const FinishTask& task, const TwinCheck& check,
                                  const Image<std::uint16_t>& rendered, const Twin& twin) {
  if (!check.wanted || !task.spec.labels.twin_exact) return TwinTally{};
  const TwinVerdict verdict =
      compare_with_twin(task.spec, rendered, twin.instance_ids, check.tolerance, rounding_of(twin));
  if (verdict.complaint.empty()) return verdict.tally;
  if (task.rejected_folder.empty()) return fail(ErrorKind::kRender, "{}", verdict.complaint);
  if (Status kept = keep_rejected(task, rendered, twin, verdict.complaint); !kept) {
    return forward_error(kept);
  }
  return fail(ErrorKind::kRender, "{}. What was rendered is kept in {}", verdict.complaint,
              task.rejected_folder.string());
}

Result<FrameLabels> label(const FinishTask& task, const std::vector<std::string>& categories,
                          const Image<std::uint16_t>& instance_ids, const Twin& twin) {
  Result<FrameLabels> labels = make_labels(task.spec, categories, instance_ids);
  if (labels) add_amodal_labels(*labels, task.spec, twin, instance_ids);
  return labels;
}

/// What both ways of finishing write.
void write_labels(const FinishTask& task, const Image<std::uint16_t>& instance_ids,
                  const FrameLabels& labels, FrameWriter& writer) {
  writer.write(frame_files::kSpec, readable_layout(canonical_text(task.spec)));
  writer.write(frame_files::kInstances, encode_png(instance_ids));
  writer.write(frame_files::kSemantic, encode_png(semantic_image(task.spec, instance_ids)));
  writer.write(frame_files::kLabels, readable_layout(canonical_text(labels)));
}

/// What the worker wrote becomes the frame's own file, without what differs from run to run.
Status keep_passes(const fs::path& rendered, FrameWriter& writer) {
  const Result<std::string> bytes = read_file(rendered);
  if (!bytes) return forward_error(bytes);
  const Result<std::string> kept = without_metadata(*bytes, rendered.string());
  if (!kept) return forward_error(kept);
  writer.write_over(rendered, frame_files::kPasses, *kept);
  return writer.status();
}

void write_data_passes(const std::optional<Image<float>>& depth,
                       const std::optional<Image<float>>& normal, FrameWriter& writer) {
  if (depth) {
    writer.make(frame_files::kDepth,
                [&](const fs::path& path) { return write_exr(path, *depth, {"Z"}); });
  }
  if (normal) {
    writer.make(frame_files::kNormal, [&](const fs::path& path) {
      return write_exr(path, *normal, {"X", "Y", "Z"});
    });
  }
}

Result<FinishedFrame> close(const FinishTask& task, const TwinTally& tally, FrameWriter& writer) {
  Manifest& manifest = writer.manifest();
  manifest.frame_id = task.frame_id;
  manifest.twin = tally;
  if (Status written = writer.write_manifest(); !written) return forward_error(written);
  return FinishedFrame{manifest.pixel_hash(), tally};
}

}  // namespace

std::map<std::string, std::string> DevelopedFrame::pixel_hashes() const {
  std::map<std::string, std::string> hashes = passes.pixel_hashes;
  hashes["image"] = pixel_hash(image, "R,G,B");
  return hashes;
}

Result<DevelopedFrame> FrameFinisher::develop(const FinishTask& task, const ColorManagement& color,
                                              bool labels) {
  Result<FramePasses> read =
      read_rendered_frame(task.spec, task.frame_id, rendered_passes(task.attempt_folder));
  if (!read) return forward_error(read);
  DevelopedFrame frame;
  frame.passes = on_whole_image(std::move(*read), task.spec.render);
  const Image<std::uint16_t>& ids = frame.passes.instance_ids;
  const Result<Twin> twin = tracer_.trace(task.spec, task.meshes, TwinTracer::Passes::kIdsOnly);
  if (!twin) return forward_error(twin);
  const Result<TwinTally> tally = check_with_twin(task, check_, ids, *twin);
  if (!tally) return forward_error(tally);
  frame.twin = *tally;
  Result<Image<std::uint8_t>> image = color.apply(frame.passes.combined, task.spec.image);
  if (image && task.spec.sensor) image = through_sensor(*image, *task.spec.sensor);
  if (!image) return forward_error(image);
  frame.image = std::move(*image);
  if (!labels) return frame;
  Result<FrameLabels> made = label(task, categories_, ids, *twin);
  if (!made) return forward_error(made);
  frame.labels = std::move(*made);
  return frame;
}

Result<FinishedFrame> FrameFinisher::write(const FinishTask& task,
                                           const DevelopedFrame& frame) const {
  const auto picture = encode_image(frame.image, encoding_);
  if (!picture) return forward_error(picture);
  const fs::path rendered = rendered_passes(task.attempt_folder);
  FrameWriter writer(task.attempt_folder);
  write_labels(task, frame.passes.instance_ids, *frame.labels, writer);
  writer.write(frame_files::image(encoding_.format), *picture);
  if (Status kept = keep_passes(rendered, writer); !kept) return forward_error(kept);
  write_data_passes(frame.passes.depth, frame.passes.normal, writer);
  writer.manifest().image = encoding_;
  writer.manifest().pixel_hashes = frame.pixel_hashes();
  Result<FinishedFrame> finished = close(task, frame.twin, writer);
  if (!finished) return finished;
  std::error_code ignored;
  fs::remove(sharp_passes(rendered), ignored);
  return finished;
}

Result<FinishedFrame> FrameFinisher::finish(const FinishTask& task, const ColorManagement& color) {
  const Result<DevelopedFrame> frame = develop(task, color);
  if (!frame) return forward_error(frame);
  return write(task, *frame);
}

Result<FinishedFrame> FrameFinisher::finish_by_twin(const FinishTask& task) {
  const Result<Twin> twin = tracer_.trace(task.spec, task.meshes, TwinTracer::Passes::kAsked);
  if (!twin) return forward_error(twin);
  const Result<FrameLabels> labels = label(task, categories_, twin->instance_ids, *twin);
  if (!labels) return forward_error(labels);
  FrameWriter writer(task.attempt_folder);
  write_labels(task, twin->instance_ids, *labels, writer);
  write_data_passes(twin->depth, twin->normal, writer);
  auto& hashes = writer.manifest().pixel_hashes;
  hashes["index"] = pixel_hash(twin->instance_ids, "X");
  if (twin->depth) hashes["depth"] = pixel_hash(*twin->depth, "float", "Z");
  if (twin->normal) hashes["normal"] = pixel_hash(*twin->normal, "float", "X,Y,Z");
  return close(task, {}, writer);
}

}  // namespace seedframe
