// One format's export while it is written: its files, documents and index.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "export/document.h"
#include "export/earlier_export.h"
#include "export/export_folder.h"
#include "export/export_index.h"
#include "export/format.h"

namespace seedframe {

/// begin, then for each frame take_earlier, reuse or an encoding, write_files and append; then
/// finish and commit. take_earlier, append and give_up are called in the order of the frames; reuse
/// and write_files from several threads.
class FormatExport {
 public:
  /// All but the folder must outlive it.
  FormatExport(const FormatEntry& entry, std::unique_ptr<ExportFormat> format, ExportFolder folder,
               const ExportOptions& options);
  FormatExport(const FormatExport&) = delete;
  FormatExport& operator=(const FormatExport&) = delete;

  Status begin(const Dataset& dataset);

  const ExportFormat& format() const { return *format_; }

  /// What an export that was there has of the frame.
  std::optional<EarlierExport::Part> take_earlier(std::int64_t frame);
  /// Takes over what was written of the frame; false if it is not what it was.
  bool reuse(const EarlierExport::Part& part, const FrameReader& files, FrameRecord& record) const;

  /// Writes the files of a frame, and leaves their names and hashes in `entry`.
  Status write_files(const FrameRecord& record, bool reused, IndexEntry& entry);
  /// Adds a frame, the `ordinal`th of its split, to the documents and the index.
  Status append(const CommittedFrame& frame, std::int64_t ordinal, const FrameRecord& record,
                bool reused, IndexEntry entry);

  /// The format cannot hold a frame: nothing more is to be done, and what was there stays.
  void give_up(Error why);
  /// Why there will be no export; none as long as all goes well.
  const Error* refusal() const { return given_up_ ? &refusal_ : nullptr; }

  /// Everything but commit.
  Status finish();
  Status commit();
  ExportSummary& summary() { return summary_; }

 private:
  struct OpenDocument {
    const DocumentKind* kind = nullptr;
    std::string split;
    DocumentWriter writer;
  };

  /// Opens a document unless it is open, and closes those of the split's earlier scene or shard.
  Status open_document(const DocumentKind& kind, const std::string& split, int scene,
                       std::int64_t shard);

  const FormatEntry& entry_;
  std::unique_ptr<ExportFormat> format_;
  std::vector<DocumentKind> kinds_;
  ExportFolder folder_;
  const ExportOptions& options_;
  ExportMarker marker_;
  std::optional<EarlierExport> earlier_;
  std::map<std::string, OpenDocument> documents_;
  std::ofstream index_;
  ExportSummary summary_;
  std::atomic<bool> given_up_ = false;  ///< refusal_ is there, and stays
  Error refusal_;
};

}  // namespace seedframe
