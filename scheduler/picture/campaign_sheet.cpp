#include "picture/campaign_sheet.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/spread.h"
#include "picture/frame_picture.h"

namespace seedframe {
namespace {

/// A tile whose size is known once a frame was read.
struct OpenTile {
  SheetTile tile;
  std::string title;  ///< of a message; empty: the tile has its pixels
  std::string text;
};

std::string counted(std::int64_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::int64_t labelled_in(const FrameLabels& labels) {
  return std::count_if(
      labels.instances.begin(), labels.instances.end(),
      [](const InstanceLabel& label) { return label.category > 0 && label.area_px > 0; });
}

/// Without "frame 7: ", where that is said already.
std::string without_frame(const std::string& message, std::int64_t frame) {
  const std::string prefix = fmt::format("frame {}: ", frame);
  return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

class SheetMaker {
 public:
  SheetMaker(const Campaign& campaign, const Dataset& dataset, const SheetWish& wish,
             const FrameExpansion& expand)
      : campaign_(campaign),
        dataset_(dataset),
        wish_(wish),
        expand_(expand),
        skeletons_(skeletons_of(dataset)),
        is_single_(wish.frames.size() == 1) {
    for (const LayerSet& tile : wish.tiles) all_layers_ = all_layers_.with(tile);
  }

  Result<CampaignSheet> make() {
    const Result<FrameCounts> counts = campaign_.store.counts();
    if (!counts) return forward_error(counts);
    for (const std::int64_t frame : wish_.frames) {
      if (Status shown = show(frame, counts->total()); !shown) return forward_error(shown);
    }
    // What has no frame of a known shape has room for a message.
    if (!size_) size_ = TileSize{most_width(), is_single_ ? 160 : 3 * most_width() / 4, 1.0};
    close_messages();
    out_.sheet.columns = wish_.columns > 0 ? wish_.columns : usual_columns();
    arrange();
    if (!wish_.plain) {
      out_.sheet.legend = seen_.legend_for(wish_.tiles);
      entitle(counts->total());
    }
    return std::move(out_);
  }

 private:
  int most_width() const {
    return wish_.tile_width > 0 ? wish_.tile_width : is_single_ ? 640 : 320;
  }
  int least_width() const {
    constexpr int kSmall = 160;
    return wish_.tile_width > 0 || is_single_ ? most_width() : kSmall;
  }

  int usual_columns() const {
    const auto count = static_cast<int>(wish_.frames.size());
    const auto tiles = static_cast<int>(wish_.tiles.size());
    return is_single_ ? columns_for(tiles, size_->width, size_->height)
                      : columns_for(count, size_->width, size_->height * tiles);
  }

  Status show(std::int64_t frame, std::int64_t total) {
    const Result<std::optional<FrameRow>> row = campaign_.store.frame(frame);
    if (!row) return forward_error(row);
    if (!*row) {
      return fail(ErrorKind::kInput, "there is no frame {}: {} has frames 0 to {}", frame,
                  campaign_.files.root().string(), total - 1);
    }
    scene_ = (*row)->scene;
    if ((*row)->state != FrameState::kDone) {
      tell_state(**row);
      return {};
    }
    const CommittedFrame committed{frame, static_cast<int>((*row)->scene),
                                   campaign_.files.frame(frame), (*row)->frame_id};
    const Result<FrameContent> content = read_content(committed, dataset_, all_layers_, expand_);
    if (content) return draw(frame, *content);
    if (content.error().kind != ErrorKind::kCorrupt) return forward_error(content);
    out_.any_corrupt = true;
    const std::string why = without_frame(content.error().message, frame);
    out_.complaints.push_back(fmt::format("frame {} is damaged: {}", frame, why));
    add_message(frame, "damaged", why);
    return {};
  }

  void tell_state(const FrameRow& row) {
    switch (row.state) {
      case FrameState::kDone:
        break;
      case FrameState::kPending:
        add_message(row.frame, "not there yet",
                    fmt::format("'seedframe resume {}' makes it.",
                                campaign_.files.root().filename().string()));
        break;
      case FrameState::kRunning:
        add_message(row.frame, "being made", "");
        break;
      case FrameState::kFailed:
        complain(row, "failed");
        break;
      case FrameState::kQuarantined:
        complain(row, "quarantined");
        break;
    }
  }

  void complain(const FrameRow& row, const std::string& state) {
    std::string error = row.error;
    std::replace(error.begin(), error.end(), '\n', ' ');
    if (row.state == FrameState::kQuarantined) {
      error = fmt::format("it has cost {} workers: {}", row.crashes, error);
    }
    out_.complaints.push_back(
        fmt::format("frame {} {}{}: {}", row.frame, state == "failed" ? "" : "is ", state, error));
    add_message(row.frame, state, error);
  }

  void add_message(std::int64_t frame, const std::string& title, const std::string& text) {
    const std::size_t tiles = is_single_ ? 1 : wish_.tiles.size();
    for (std::size_t i = 0; i < tiles; ++i) {
      OpenTile open;
      open.title = title;
      open.text = text;
      if (!is_single_) open.tile.caption = caption(frame, i);
      tiles_.push_back(std::move(open));
    }
  }

  Status draw(std::int64_t frame, const FrameContent& content) {
    const TileSize size = tile_size(content.instance_ids.width, content.instance_ids.height,
                                    most_width(), least_width());
    if (!size_) size_ = size;
    const std::size_t tiles = wish_.frames.size() * wish_.tiles.size();
    const double pixels = static_cast<double>(tiles) * size.width * size.height;
    if (pixels > kMostSheetPixels) {
      return fail(
          ErrorKind::kInput,
          "{} tiles of {} × {} pixels are more than the {:.0f} million pixels that a picture "
          "may have: show fewer frames, or smaller ones (--tile-width)",
          tiles, size.width, size.height, kMostSheetPixels / 1e6);
    }
    frame_width_ = content.instance_ids.width;
    frame_height_ = content.instance_ids.height;
    objects_ = labelled_in(content.labels);
    seen_.add(content.labels);
    for (std::size_t i = 0; i < wish_.tiles.size(); ++i) {
      FramePicture picture = draw_frame(content, wish_.tiles[i], size, skeletons_);
      OpenTile open;
      open.tile.pixels = std::move(picture.pixels);
      open.tile.caption = caption(frame, i);
      open.tile.note = std::move(picture.note);
      if (i == 0 && !is_single_ && open.tile.note.empty()) {
        open.tile.note = counted(objects_, "object");
      }
      tiles_.push_back(std::move(open));
    }
    return {};
  }

  std::string caption(std::int64_t frame, std::size_t tile) const {
    if (is_single_) return wish_.tiles[tile].name();
    return tile == 0 ? fmt::format("frame {}", frame) : wish_.tiles[tile].name();
  }

  void close_messages() {
    for (OpenTile& open : tiles_) {
      if (!open.title.empty()) open.tile.pixels = draw_message(open.title, open.text, *size_);
    }
  }

  /// From the tiles of frame after frame to rows.
  void arrange() {
    std::vector<SheetTile>& out = out_.sheet.tiles;
    const std::size_t each = wish_.tiles.size(), frames = tiles_.size() / each;
    const auto columns = static_cast<std::size_t>(out_.sheet.columns);
    for (OpenTile& open : tiles_) {
      if (wish_.plain) open.tile.caption.clear(), open.tile.note.clear();
    }
    if (is_single_ || each == 1) {
      for (OpenTile& open : tiles_) out.push_back(std::move(open.tile));
      return;
    }
    out_.sheet.columns = static_cast<int>(std::min(columns, frames));
    for (std::size_t first = 0; first < frames; first += columns) {
      for (std::size_t tile = 0; tile < each; ++tile) {
        for (std::size_t frame = first; frame < first + std::min(columns, frames); ++frame) {
          out.push_back(frame < frames ? std::move(tiles_[frame * each + tile].tile) : SheetTile{});
        }
      }
    }
  }

  void entitle(std::int64_t total) {
    ContactSheet& sheet = out_.sheet;
    sheet.title = dataset_.name;
    const std::string pixels =
        frame_width_ == 0 ? "" : fmt::format(" · {} × {} px", frame_width_, frame_height_);
    if (!is_single_) {
      sheet.subtitle =
          fmt::format("{} of {}{}", wish_.frames.size(), counted(total, "frame"), pixels);
      return;
    }
    sheet.subtitle =
        fmt::format("frame {} of {} · scene {}{}", wish_.frames[0], total, scene_, pixels);
    if (frame_width_ > 0) sheet.subtitle += " · " + counted(objects_, "object");
  }

  const Campaign& campaign_;
  const Dataset& dataset_;
  const SheetWish& wish_;
  const FrameExpansion& expand_;
  Skeletons skeletons_;
  bool is_single_;
  LayerSet all_layers_;
  std::optional<TileSize> size_;
  int frame_width_ = 0, frame_height_ = 0;
  std::int64_t scene_ = 0, objects_ = 0;  ///< of the last frame
  SeenLabels seen_;
  std::vector<OpenTile> tiles_;
  CampaignSheet out_;
};

}  // namespace

Result<std::vector<std::int64_t>> frames_worth_showing(const Campaign& campaign,
                                                       std::int64_t most) {
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return forward_error(counts);
  if (counts->pending + counts->running == 0) return spread_over(counts->total(), most);
  std::vector<std::int64_t> ended;
  const Status visited = campaign.store.for_each_frame([&](const FrameRow& row) -> Status {
    if (row.state != FrameState::kPending && row.state != FrameState::kRunning) {
      ended.push_back(row.frame);
    }
    return {};
  });
  if (!visited) return forward_error(visited);
  std::vector<std::int64_t> frames;
  for (const std::int64_t at : spread_over(static_cast<std::int64_t>(ended.size()), most)) {
    frames.push_back(ended[static_cast<std::size_t>(at)]);
  }
  return frames;
}

std::vector<LayerSet> usual_tiles(const Dataset& dataset, std::size_t frames) {
  const LayerSet labels = {Layer::kBoxes, Layer::kNames};
  const LayerSet masks = {Layer::kInstances};
  if (frames > 1) {
    return {labels.with(dataset.has_images ? LayerSet{Layer::kImage} : masks)};
  }
  std::vector<LayerSet> tiles;
  if (dataset.has_images) {
    tiles = {{Layer::kImage},
             labels.with({Layer::kImage}),
             masks.with({Layer::kImage}),
             {Layer::kImage, Layer::kAmodal}};
  } else {
    tiles = {labels.with(masks), {Layer::kAmodal}};
  }
  tiles.push_back({Layer::kSemantic});
  if (dataset.has_depth) tiles.push_back({Layer::kDepth});
  return tiles;
}

Result<CampaignSheet> make_sheet(const Campaign& campaign, const Dataset& dataset,
                                 const SheetWish& wish, const FrameExpansion& expand) {
  return SheetMaker(campaign, dataset, wish, expand).make();
}

}  // namespace seedframe
