// The interface of an export format. What all formats have in common is in export_run.h.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "export/dataset.h"
#include "export/document.h"
#include "export/export_frame.h"
#include "export/export_options.h"
#include "export/frame_record.h"
#include "export/written_frame.h"

namespace seedframe {

struct SplitSummary {
  std::string split;
  std::int64_t images = 0;
  std::int64_t background_images = 0;  ///< images without an annotation
  Counts counts{};
};

struct ExportSummary {
  std::string format;
  std::filesystem::path folder;
  std::int64_t frames = 0;
  std::int64_t reused = 0;  ///< frames taken over from the export that was there
  std::vector<SplitSummary> splits;
  std::set<std::filesystem::path> folders;  ///< that hold files of frames
  std::vector<std::string> warnings;
};

/// What of an export belongs to no frame. Paths are relative to its folder.
struct CommonPart {
  std::map<std::string, std::string> files;    ///< bytes by path
  std::vector<std::filesystem::path> folders;  ///< that are there even when nothing is in them
  std::vector<std::string> warnings;
};

/// One format for one dataset, made with its options. encode and differences may be called from
/// several threads at once, for frames in any order.
class ExportFormat {
 public:
  virtual ~ExportFormat() = default;

  /// What encode reads beside the labels.
  virtual FrameParts needs() const { return {}; }
  virtual std::vector<DocumentKind> documents() const { return {}; }
  /// Folders that are there even when nothing is in them.
  virtual std::vector<std::filesystem::path> folders() const { return {}; }
  /// Whether a frame's record says all there is about it; false: every frame is encoded each time.
  virtual bool reusable() const { return true; }

  /// A kInput error for a frame that the format cannot hold: then there is no export in it.
  virtual Result<FrameRecord> encode(const ExportFrame& frame) const = 0;
  /// After all frames were encoded, taken over or compared.
  virtual Result<CommonPart> common_part(const ExportSummary&) const { return CommonPart{}; }
  /// Whether programs that train on an export leave a file of this path in it.
  virtual bool is_left_by_trainers(const std::string&) const { return false; }

  /// Decodes what was written of a frame and compares it with the frame. Empty when all is equal.
  /// Images that are placed as they are, and names, have been compared already.
  virtual std::vector<std::string> differences(const ExportFrame& frame,
                                               const WrittenFrame& written) const = 0;
};

struct FormatEntry {
  const char* name;
  const char* description;
  /// kInput errors for a dataset or options that the format cannot hold.
  Result<std::unique_ptr<ExportFormat>> (*make)(const Dataset&, const ExportOptions&);
};

using FormatList = std::vector<FormatEntry>;

/// A kInput error with "did you mean" for a name that none of them has.
Result<const FormatEntry*> find_format(const FormatList& formats, std::string_view name);

}  // namespace seedframe
