// A frame as a format sees it: loaded, with the instances that are exported.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "annotate/mask.h"
#include "base/error.h"
#include "export/dataset.h"
#include "export/export_options.h"
#include "export/frame_record.h"

namespace seedframe {

struct ExportInstance {
  const InstanceLabel* label = nullptr;
  Mask mask;                 ///< of the visible pixels, or of the silhouette inside the image
  std::int64_t area_px = 0;  ///< of the mask
  const PixelRect& box() const { return mask.box(); }

  /// Holds the silhouette that the mask looks at; none: it looks at the frame's instance ids.
  std::shared_ptr<const Image<std::uint16_t>> silhouette;
};

struct ExportFrame {
  CommittedFrame frame;
  LoadedFrame loaded;
  std::string split;  ///< its name
  std::string stem;   ///< "000042"
  struct LeftOut {
    const InstanceLabel* label = nullptr;
    Count why = Count::kTooSmall;
  };
  std::vector<ExportInstance> instances;
  std::vector<LeftOut> left_out;  ///< by the options, in the order of labels.json

  ExportFrame() = default;
  ExportFrame(ExportFrame&&) = delete;  // the instances look into it
  ExportFrame& operator=(ExportFrame&&) = delete;
};

/// The image's name in exports, "000042.png": the ending is that of its file.
std::string image_name(const ExportFrame& frame);

/// The frame's image, to be placed at a path of the export.
PlacedFile image_at(const std::filesystem::path& path, const ExportFrame& frame);

/// An instance by its whole silhouette inside the image. A kInput error names the frame if it has
/// none that is exact.
Result<ExportInstance> whole_instance(const CommittedFrame& frame, const LoadedFrame& loaded,
                                      const InstanceLabel& label);

/// What the format exports of the frame, and what the options left out: of all instances, or of
/// those that the format asks for.
Counts count_instances(const ExportFrame& frame);
Counts count_instances(const ExportFrame& frame,
                       const std::function<bool(const InstanceLabel&)>& asked_for);

/// The instances that the options let through, in the order of labels.json. kInput errors name a
/// frame that has no exact silhouettes though they are asked for.
Result<std::unique_ptr<ExportFrame>> select_instances(const CommittedFrame& frame,
                                                      LoadedFrame loaded, std::string split,
                                                      const ExportOptions& options);

}  // namespace seedframe
