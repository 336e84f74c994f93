#include "audit/campaign_comparison.h"

#include <algorithm>
#include <array>
#include <map>

#include "audit/json_difference.h"
#include "base/files.h"
#include "campaign/provenance.h"
#include "image/png_file.h"

namespace seedframe {
namespace {

using Kind = ComparedFrame::Kind;

constexpr std::size_t kMostSpecDifferences = 8;
constexpr int kFramesAtOnce = 4096;

/// Rows of the frames [first, first + count), those that are done.
Result<std::map<std::int64_t, FrameRow>> done_frames(const Campaign& campaign, std::int64_t first,
                                                     std::int64_t count) {
  std::map<std::int64_t, FrameRow> rows;
  for (std::int64_t at = first; at < first + count; at += kFramesAtOnce) {
    const auto most = static_cast<int>(std::min<std::int64_t>(kFramesAtOnce, first + count - at));
    auto some = campaign.store.frames_from(at, most);
    if (!some) return forward_error(some);
    for (FrameRow& row : *some) {
      if (row.state == FrameState::kDone && row.frame < first + count) {
        rows.emplace(row.frame, std::move(row));
      }
    }
  }
  return rows;
}

/// What the attempt was made with that is the frame's present state; empty object if unknown.
Result<Json> provenance_of(const Campaign& campaign, std::int64_t frame) {
  const auto attempts = campaign.store.attempts(frame);
  if (!attempts) return forward_error(attempts);
  for (auto row = attempts->rbegin(); row != attempts->rend(); ++row) {
    if (row->outcome == AttemptOutcome::kDone && !row->provenance.empty()) {
      return parse_json(row->provenance, "the job store's provenance");
    }
  }
  return Json::object();
}

Result<Json> read_spec(const Campaign& campaign, std::int64_t frame) {
  const auto path = campaign.files.frame(frame) / frame_files::kSpec;
  const Result<std::string> text = read_file(path);
  if (!text) return forward_error(text);
  return parse_json(*text, path.string());
}

class Comparer {
 public:
  Comparer(const Campaign& first, const Campaign& second, const Tolerance& tolerance,
           std::int64_t most_frames, const std::filesystem::path& heat_maps)
      : first_(first),
        second_(second),
        tolerance_(tolerance),
        most_frames_(most_frames),
        heat_maps_(heat_maps) {}

  Result<CampaignComparison> compare() {
    const auto a = first_.store.scene_hashes();
    if (!a) return forward_error(a);
    const auto b = second_.store.scene_hashes();
    if (!b) return forward_error(b);
    std::int64_t next = 0;  // the first frame that has not been compared
    for (std::size_t scene = 0; scene < std::max(a->size(), b->size()); ++scene) {
      const SceneHash* x = scene < a->size() ? &(*a)[scene] : nullptr;
      const SceneHash* y = scene < b->size() ? &(*b)[scene] : nullptr;
      if (x != nullptr && y != nullptr && !x->hash.empty() && x->hash == y->hash) {
        result_.identical += x->frames;
        next = x->first_frame + x->frames;
        continue;
      }
      // Scenes of another size share no hash; the longer one says how far to go.
      const std::int64_t end = std::max(x != nullptr ? x->first_frame + x->frames : 0,
                                        y != nullptr ? y->first_frame + y->frames : 0);
      if (end <= next) continue;
      if (Status compared = compare_frames(next, end - next); !compared) {
        return forward_error(compared);
      }
      next = end;
    }
    const auto first_hash = first_.store.dataset_hash();
    if (!first_hash) return forward_error(first_hash);
    const auto second_hash = second_.store.dataset_hash();
    if (!second_hash) return forward_error(second_hash);
    result_.first_hash = *first_hash;
    result_.second_hash = *second_hash;
    return std::move(result_);
  }

 private:
  Status compare_frames(std::int64_t begin, std::int64_t count) {
    const auto a = done_frames(first_, begin, count);
    if (!a) return forward_error(a);
    const auto b = done_frames(second_, begin, count);
    if (!b) return forward_error(b);
    for (std::int64_t frame = begin; frame < begin + count; ++frame) {
      const auto x = a->find(frame);
      const auto y = b->find(frame);
      if (x == a->end() && y == b->end()) continue;
      if (x == a->end() || y == b->end()) {
        ComparedFrame& missing = result_.frames.emplace_back();
        missing.frame = frame;
        missing.kind = y == b->end() ? Kind::kOnlyInFirst : Kind::kOnlyInSecond;
        continue;
      }
      if (x->second.frame_id == y->second.frame_id &&
          x->second.pixel_hash == y->second.pixel_hash) {
        ++result_.identical;
        continue;
      }
      const bool other_spec = x->second.frame_id != y->second.frame_id;
      if (Status seen = look_at(frame, other_spec ? Kind::kOtherSpec : Kind::kOtherPixels); !seen) {
        return seen;
      }
    }
    return {};
  }

  Status look_at(std::int64_t frame, Kind kind) {
    ComparedFrame& compared = result_.frames.emplace_back();
    compared.frame = frame;
    compared.kind = kind;
    if (looked_at_ == most_frames_) return {};
    ++looked_at_;
    const auto a = first_.files.frame(frame);
    const auto b = second_.files.frame(frame);
    if (kind == Kind::kOtherSpec) {
      const Result<Json> x = read_spec(first_, frame);
      if (!x) return forward_error(x);
      const Result<Json> y = read_spec(second_, frame);
      if (!y) return forward_error(y);
      compared.spec = json_differences(*x, *y, kMostSpecDifferences);
    }
    const Result<Manifest> x = read_manifest(a);
    if (!x) return forward_error(x);
    const Result<Manifest> y = read_manifest(b);
    if (!y) return forward_error(y);
    Result<FrameDifference> difference = difference_of_frames(a, *x, b, *y, tolerance_);
    if (!difference) return forward_error(difference);
    result_.grade = std::max(result_.grade, difference->grade);
    compared.difference = std::move(*difference);
    const Result<Json> made_first = provenance_of(first_, frame);
    if (!made_first) return forward_error(made_first);
    const Result<Json> made_second = provenance_of(second_, frame);
    if (!made_second) return forward_error(made_second);
    compared.provenance = describe_difference(*made_second, *made_first);
    return heat_maps_.empty() ? Status() : write_heat_map(frame);
  }

  Status write_heat_map(std::int64_t frame) {
    const auto map = heat_map_of_frames(first_.files.frame(frame), second_.files.frame(frame));
    if (!map) return map.error().kind == ErrorKind::kInput ? Status() : forward_error(map);
    if (Status made = make_folders(heat_maps_); !made) return made;
    return write_file_atomically(heat_maps_ / (frame_stem(frame) + ".png"), encode_png(*map));
  }

  const Campaign& first_;
  const Campaign& second_;
  const Tolerance& tolerance_;
  std::int64_t most_frames_;
  const std::filesystem::path& heat_maps_;
  std::int64_t looked_at_ = 0;
  CampaignComparison result_;
};

}  // namespace

const char* to_string(Kind kind) {
  constexpr std::array<const char*, 4> kNames = {"only in the first", "only in the second",
                                                 "asked for otherwise", "other pixels"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::int64_t CampaignComparison::count(Kind kind) const {
  return std::count_if(frames.begin(), frames.end(),
                       [&](const ComparedFrame& frame) { return frame.kind == kind; });
}

Result<CampaignComparison> compare_campaigns(const Campaign& first, const Campaign& second,
                                             const Tolerance& tolerance, std::int64_t most_frames,
                                             const std::filesystem::path& heat_maps) {
  return Comparer(first, second, tolerance, most_frames, heat_maps).compare();
}

Json to_json(const CampaignComparison& comparison) {
  Json frames = Json::array();
  for (const ComparedFrame& frame : comparison.frames) {
    Json each = {{"frame", frame.frame}, {"kind", to_string(frame.kind)}};
    if (!frame.spec.empty()) each["spec"] = frame.spec;
    if (!frame.provenance.empty()) each["provenance"] = frame.provenance;
    if (frame.difference) each["difference"] = to_json(*frame.difference);
    frames.push_back(std::move(each));
  }
  return {{"first_hash", comparison.first_hash},
          {"second_hash", comparison.second_hash},
          {"identical", comparison.identical},
          {"grade", to_string(comparison.grade)},
          {"frames", frames}};
}

}  // namespace seedframe
