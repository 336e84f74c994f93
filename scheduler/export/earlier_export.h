// What an export with the same options left in the folder: the parts of frames that are still as
// they were need not be made again.
#pragma once

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
#include "export/export_index.h"

namespace seedframe {

/// Reads an export's index and documents in the order of the frames, in step with each other.
class EarlierExport {
 public:
  /// None when there is no export, or one of another format, dataset or with other options.
  static std::optional<EarlierExport> open(const std::filesystem::path& folder,
                                           const ExportMarker& marker,
                                           const std::vector<DocumentKind>& documents);
  /// Of any export; an index that is not there is an error.
  static Result<EarlierExport> open_for_reading(const std::filesystem::path& folder,
                                                const std::vector<SplitShare>& splits,
                                                const std::vector<DocumentKind>& documents);

  struct Part {
    IndexEntry entry;
    std::vector<Chunk> chunks;  ///< as many as entry.pieces, or fewer if not all can be read
    bool whole = false;         ///< every chunk is there and has its hash; files were not looked at
  };
  /// The part of a frame, if the export has one. Frames must be asked for by rising index.
  std::optional<Part> take(std::int64_t frame);
  /// The next part, whatever its frame.
  std::optional<Part> next();

  /// Documents that hold more than was taken from them, or that cannot be read.
  std::vector<std::string> not_read_to_the_end() const;

  /// Opens the documents of splits in which no frame has an entry; they must be empty.
  void open_empty_documents();

  const std::filesystem::path& folder() const { return folder_; }

 private:
  bool read_entry();
  Part read_part();
  std::optional<std::string> read_piece(const IndexEntry::Piece& piece, const std::string& split,
                                        int& document);

  std::filesystem::path folder_;
  std::vector<SplitShare> splits_;
  std::vector<DocumentKind> kinds_;
  std::ifstream index_;
  std::optional<IndexEntry> entry_;  ///< read, and not taken
  struct Document {
    std::optional<DocumentReader> reader;  ///< none: it cannot be read
    bool of_split = true;                  ///< stays open to the end
  };
  std::map<std::string, Document> open_documents_;
};

}  // namespace seedframe
