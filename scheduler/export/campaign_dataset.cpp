#include "export/campaign_dataset.h"

#include <deque>

namespace seedframe {
namespace {

/// Goes through the store a thousand rows at a time.
class DoneFrames {
 public:
  explicit DoneFrames(const Campaign& campaign) : campaign_(&campaign) {}

  Result<std::optional<CommittedFrame>> next() {
    constexpr int kRows = 1000;
    while (true) {
      if (rows_.empty()) {
        auto rows = campaign_->store.frames_from(first_, kRows);
        if (!rows) return forward_error(rows);
        if (rows->empty()) return std::nullopt;
        first_ = rows->back().frame + 1;
        rows_.assign(std::make_move_iterator(rows->begin()), std::make_move_iterator(rows->end()));
      }
      const FrameRow row = std::move(rows_.front());
      rows_.pop_front();
      if (row.state != FrameState::kDone) continue;
      return CommittedFrame{row.frame, static_cast<int>(row.scene),
                            campaign_->files.frame(row.frame), row.frame_id};
    }
  }

 private:
  const Campaign* campaign_;
  std::int64_t first_ = 0;
  std::deque<FrameRow> rows_;
};

}  // namespace

Result<CampaignDataset> campaign_dataset(const Campaign& campaign, KeptInputs inputs) {
  CampaignDataset out;
  Dataset& dataset = out.dataset;
  dataset.name = std::move(inputs.name);
  dataset.seed = inputs.seed;
  dataset.categories = std::move(inputs.categories);
  dataset.assets = std::move(inputs.assets);
  dataset.keypoints = class_keypoints(dataset.assets, dataset.categories);
  dataset.has_images = inputs.has_images;
  dataset.image_format = inputs.image_format;
  dataset.has_depth = inputs.has_depth;
  dataset.frames = [&campaign] {
    return [frames = std::make_shared<DoneFrames>(campaign)] { return frames->next(); };
  };
  const auto counts = campaign.store.counts();
  if (!counts) return forward_error(counts);
  out.missing = counts->total() - counts->done;
  return out;
}

}  // namespace seedframe
