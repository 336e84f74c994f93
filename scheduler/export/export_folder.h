// The folder of an export: built aside, and put in place of the old one when it is whole.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

#include "base/error.h"

namespace seedframe {

/// Names OUTPUT/<name>; until commit() everything goes to OUTPUT/.<name>.partial, which the
/// destructor removes. Files may be written from several threads at once.
class ExportFolder {
 public:
  /// A kInput error when OUTPUT/<name> holds something that is not an export of Seedframe: it would
  /// be lost.
  static Result<ExportFolder> create(const std::filesystem::path& output, const std::string& name);
  ~ExportFolder();
  ExportFolder(ExportFolder&& other) noexcept;
  ExportFolder& operator=(ExportFolder&&) = delete;

  /// Where to write now.
  const std::filesystem::path& partial() const { return partial_; }
  /// Where it will be after commit().
  const std::filesystem::path& destination() const { return destination_; }

  Status make_folder(const std::filesystem::path& relative);
  /// Makes the folders above too. Unlike write_file, leaves it to commit() to force the bytes to
  /// the disk, once for all files.
  Status write(const std::filesystem::path& relative, std::string_view bytes);
  /// Links the file, or copies it where links are not wanted or not possible.
  Status place(const std::filesystem::path& source, const std::filesystem::path& relative,
               bool link);

  /// `marker`: the content of seedframe.json, by which create() knows the folder again.
  Status commit(std::string_view marker);

 private:
  ExportFolder(std::filesystem::path partial, std::filesystem::path destination);

  struct MadeFolders {
    std::mutex mutex;
    std::set<std::filesystem::path> paths;
  };
  std::filesystem::path partial_;
  std::filesystem::path destination_;
  std::unique_ptr<MadeFolders> made_ = std::make_unique<MadeFolders>();
};

}  // namespace seedframe
