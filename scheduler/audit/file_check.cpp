#include "audit/file_check.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <unordered_map>

#include <tbb/parallel_for.h>

#include "audit/provenance_check.h"
#include "base/files.h"
#include "frames/frame_contents.h"
#include "frames/frame_reader.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

struct CheckedFrame {
  std::uint64_t bytes = 0;
  std::vector<std::string> problems;
  bool other_inputs = false;
  UsedFiles used;
};

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

class FilesOfCampaign {
 public:
  FilesOfCampaign(const Campaign& campaign, const FileReference& reference, bool same_rays)
      : campaign_(campaign), reference_(reference), same_rays_(same_rays) {}

  Result<FileCheck> check() {
    constexpr int kReadAtOnce = 4096;
    while (true) {
      auto rows = campaign_.store.frames_from(next_, kReadAtOnce);
      if (!rows) return forward_error(rows);
      if (rows->empty()) break;
      for (const FrameRow& row : *rows) {
        note_gap(row.frame);
        next_ = row.frame + 1;
      }
      std::erase_if(*rows, [](const FrameRow& row) { return row.state != FrameState::kDone; });
      std::vector<CheckedFrame> checked(rows->size());
      tbb::parallel_for(std::size_t{0}, rows->size(),
                        [&](std::size_t i) { checked[i] = check_frame((*rows)[i]); });
      for (std::size_t i = 0; i < rows->size(); ++i) take((*rows)[i], std::move(checked[i]));
    }
    compare_count();
    name_strange_frames();
    check_.duplicates = twins_.groups();
    const PreparedCampaign* same = check_.other_inputs.empty() ? reference_.prepared : nullptr;
    for (std::string& problem : wrong_provenance(campaign_, same, used_)) {
      complain(std::move(problem));
    }
    return std::move(check_);
  }

 private:
  void compare_count() {
    if (reference_.prepared == nullptr) return;
    const std::int64_t all = reference_.prepared->expander.frame_count();
    note_gap(all);
    if (next_ > all) {
      complain(fmt::format("the job store has {} frames, the config makes {}", next_, all));
    }
  }
  void complain(std::string problem) { check_.of_no_frame.push_back(std::move(problem)); }

  /// `frame` is the next one there is, or the end.
  void note_gap(std::int64_t frame) {
    if (frame <= next_) return;
    complain(frame == next_ + 1
                 ? fmt::format("the job store does not know frame {}", next_)
                 : fmt::format("the job store does not know frames {} to {}", next_, frame - 1));
  }

  CheckedFrame check_frame(const FrameRow& row) {
    CheckedFrame checked;
    const fs::path folder = campaign_.files.frame(row.frame);
    const Result<Manifest> manifest = verify_frame(folder, row.frame_id, VerifyDepth::kContents);
    if (!manifest) {
      checked.problems.push_back(manifest.error().message);
      return checked;
    }
    for (const auto& [name, file] : manifest->files) checked.bytes += file.bytes;
    if (manifest->pixel_hash() != row.pixel_hash) {
      checked.problems.push_back(folder.string() +
                                 ": its pixel hash is not the one in the job store");
    }
    std::optional<ExpandedFrame> expanded;
    if (reference_.prepared != nullptr) {
      Result<ExpandedFrame> today = reference_.prepared->expander.expand(row.frame);
      checked.other_inputs = !today || today->id != row.frame_id;
      if (!checked.other_inputs) expanded = std::move(*today);
    }
    ContentWish wish{reference_.categories, nullptr, same_rays_};
    FrameSpec spec;
    if (expanded) {
      checked.used = std::move(expanded->used);
      spec = std::move(expanded->spec);
      wish.meshes = &expanded->meshes;
    } else if (auto stored = stored_spec(folder)) {
      spec = std::move(*stored);
      if (frame_id(spec) != row.frame_id) {
        checked.problems.push_back((folder / frame_files::kSpec).string() +
                                   " is not the spec of its frame id");
      }
    } else {
      checked.problems.push_back(stored.error().message);
      return checked;
    }
    for (const std::string& complaint : wrong_contents(folder, *manifest, spec, wish, tracer_)) {
      checked.problems.push_back((folder / "").string() + complaint);
    }
    return checked;
  }

  void take(const FrameRow& row, CheckedFrame checked) {
    ++check_.frames;
    check_.bytes += checked.bytes;
    twins_.add(row);
    if (checked.other_inputs) check_.other_inputs.push_back(row.frame);
    for (std::string& problem : checked.problems) {
      check_.problems.push_back({row.frame, std::move(problem)});
    }
    used_.add(checked.used);
  }

  /// What lies below frames/ and is no folder of a frame that the store knows.
  void name_strange_frames() {
    std::vector<std::string> strange;
    std::error_code error;
    const fs::path frames = campaign_.files.frames();
    for (const auto& thousand : fs::directory_iterator(frames, error)) {
      if (!thousand.is_directory()) {
        strange.push_back(fs::relative(thousand.path(), campaign_.files.root()).string());
        continue;
      }
      for (const auto& entry : fs::directory_iterator(thousand.path(), error)) {
        const std::string name = entry.path().filename().string();
        std::int64_t index = -1;
        std::from_chars(name.data(), name.data() + name.size(), index);
        const bool known =
            index >= 0 && index < next_ && entry.path() == campaign_.files.frame(index);
        if (!known) strange.push_back(fs::relative(entry.path(), campaign_.files.root()).string());
      }
    }
    std::sort(strange.begin(), strange.end());
    for (const std::string& path : strange) complain(path + " is of no frame");
  }

  const Campaign& campaign_;
  const FileReference& reference_;
  bool same_rays_;
  TwinTracer tracer_;
  FileCheck check_;
  Twins twins_;
  UsedFiles used_;
  std::int64_t next_ = 0;  ///< index behind the last row that was seen
};

}  // namespace

Result<FileCheck> check_files(const Campaign& campaign, const FileReference& reference) {
  const Result<bool> same_rays = traced_like_here(campaign.store);
  if (!same_rays) return forward_error(same_rays);
  return FilesOfCampaign(campaign, reference, *same_rays).check();
}

}  // namespace seedframe
