// Post-processing of one attempt: from the worker's EXR, or from the twin alone, to the files of
// the frame.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "annotate/labels.h"
#include "base/error.h"
#include "image/color_management.h"
#include "image/pass_reader.h"
#include "spec/frame_spec.h"
#include "spec/image_encoding.h"
#include "spec/twin_check.h"
#include "twin/twin.h"

namespace seedframe {

struct FinishTask {
  FrameSpec spec;
  std::string frame_id;
  MeshBuffers meshes;                    ///< of the spec's instances
  std::filesystem::path attempt_folder;  ///< holds the worker's passes
  /// Made for a frame that is not as its twin sees it; empty: nothing of it is kept.
  std::filesystem::path rejected_folder;
};

/// A rendered frame that was found good, in memory.
struct DevelopedFrame {
  FramePasses passes;         ///< on the whole image
  Image<std::uint8_t> image;  ///< RGB, for a display
  std::optional<FrameLabels> labels;
  TwinTally twin;

  /// As a manifest has them.
  std::map<std::string, std::string> pixel_hashes() const;
};

struct FinishedFrame {
  std::string pixel_hash;
  TwinTally twin;
};

/// Writes the files of frames into their attempt folders; StoreWriter brings them to the disk and
/// into place. A kRender error is the worker's fault, a kEnvironment error the disk's. Thread-safe.
class FrameFinisher {
 public:
  /// `twin_threads` trace each frame.
  FrameFinisher(std::vector<std::string> categories, const TwinCheck& check, int twin_threads,
                const ImageEncoding& encoding = {})
      : categories_(std::move(categories)),
        check_(check),
        tracer_(twin_threads),
        encoding_(encoding) {}

  /// Reads and checks the passes, compares them with the frame's twin, and writes the picture,
  /// instances.png, semantic.png, labels.json, frame.json, the passes without dates, depth.exr and
  /// normal.exr when asked for, and the manifest. A frame that differs from its twin is an error,
  /// and what was rendered is kept in the rejected folder.
  Result<FinishedFrame> finish(const FinishTask& task, const ColorManagement& color);

  /// Its first half, in memory: reads and checks the passes, and makes the picture and, if they are
  /// wanted, labels.
  Result<DevelopedFrame> develop(const FinishTask& task, const ColorManagement& color,
                                 bool labels = true);
  /// Its second half: writes the files, of a frame that was developed with its labels.
  Result<FinishedFrame> write(const FinishTask& task, const DevelopedFrame& frame) const;

  /// The same files without the image and the passes, from the twin; no worker was asked.
  Result<FinishedFrame> finish_by_twin(const FinishTask& task);

 private:
  std::vector<std::string> categories_;
  TwinCheck check_;
  TwinTracer tracer_;
  ImageEncoding encoding_;
};

}  // namespace seedframe
