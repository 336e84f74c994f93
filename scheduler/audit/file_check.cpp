#include "audit/file_check.h"

#include <algorithm>
#include <unordered_map>

#include <tbb/parallel_for.h>

namespace seedframe {
namespace {

struct CheckedFrame {
  std::uint64_t bytes = 0;
  std::string problem;
};

CheckedFrame check_frame(const Campaign& campaign, const FrameRow& row) {
  const auto folder = campaign.files.frame(row.frame);
  const Result<Manifest> manifest = verify_frame(folder, row.frame_id, VerifyDepth::kContents);
  if (!manifest) return {0, manifest.error().message};
  CheckedFrame checked;
  for (const auto& [name, file] : manifest->files) checked.bytes += file.bytes;
  if (manifest->pixel_hash() != row.pixel_hash) {
    checked.problem = folder.string() + ": its pixel hash is not the one in the job store";
  }
  return checked;
}

/// Frames by their pixels.
class Twins {
 public:
  void add(const FrameRow& row) {
    const auto [first, is_new] = first_.try_emplace(row.pixel_hash, row.frame, row.frame_id);
    if (is_new) return;
    FileCheck::Duplicates& group = groups_[first->second.first];
    if (group.frames.empty()) group = {{first->second.first}, true};
    group.frames.push_back(row.frame);
    group.same_spec = group.same_spec && row.frame_id == first->second.second;
  }
  std::vector<FileCheck::Duplicates> groups() const {
    std::vector<FileCheck::Duplicates> all;
    all.reserve(groups_.size());
    for (const auto& group : groups_) all.push_back(group.second);
    return all;
  }

 private:
  std::unordered_map<std::string, std::pair<std::int64_t, std::string>> first_;
  std::map<std::int64_t, FileCheck::Duplicates> groups_;
};

}  // namespace

Result<FileCheck> check_files(const Campaign& campaign) {
  constexpr int kReadAtOnce = 4096;
  FileCheck check;
  Twins twins;
  for (std::int64_t first = 0;;) {
    auto rows = campaign.store.frames_from(first, kReadAtOnce);
    if (!rows) return forward_error(rows);
    if (rows->empty()) break;
    first = rows->back().frame + 1;
    std::erase_if(*rows, [](const FrameRow& row) { return row.state != FrameState::kDone; });
    std::vector<CheckedFrame> checked(rows->size());
    tbb::parallel_for(std::size_t{0}, rows->size(),
                      [&](std::size_t i) { checked[i] = check_frame(campaign, (*rows)[i]); });
    for (std::size_t i = 0; i < rows->size(); ++i) {
      ++check.frames;
      check.bytes += checked[i].bytes;
      twins.add((*rows)[i]);
      if (!checked[i].problem.empty()) {
        check.problems.push_back({(*rows)[i].frame, std::move(checked[i].problem)});
      }
    }
  }
  check.duplicates = twins.groups();
  return check;
}

}  // namespace seedframe
