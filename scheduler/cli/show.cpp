// seedframe show: pictures of a campaign's frames and of their labels.

#include <charconv>
#include <memory>
#include <optional>
#include <string_view>

#include <CLI/CLI.hpp>

#include "campaign/campaign.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/open_file.h"
#include "console/say.h"
#include "export/campaign_dataset.h"
#include "manual/describe_command.h"
#include "picture/campaign_sheet.h"
#include "picture/picture_file.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kUsualFrames = 12;
constexpr std::int64_t kMostTiles = 1000;

struct ShowArguments {
  std::string folder;
  std::vector<std::string> frames;
  std::string output;
  std::string layers;
  std::string sheet;
  std::vector<std::string> allowed;
  int tile_width = 0;
  bool plain = false;
  bool overwrite = false;
  bool open = false;
};

/// The whole of a text as a number from 0 on.
std::optional<std::int64_t> number_of(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && number >= 0 ? std::optional(number) : std::nullopt;
}

/// "6x4": columns and rows of tiles; "6": columns alone, and rows 0.
struct SheetShape {
  int columns = 0;
  int rows = 0;
};

Result<SheetShape> parse_shape(const std::string& text, std::size_t tiles) {
  if (text.empty()) return SheetShape{};
  const std::size_t cross = std::min(text.find('x'), text.size());
  const auto columns = number_of(std::string_view(text).substr(0, cross));
  const auto rows = cross == text.size() ? std::optional<std::int64_t>(0)
                                         : number_of(std::string_view(text).substr(cross + 1));
  const bool has_rows = cross < text.size();
  if (!columns || !rows || *columns < 1 || *columns > kMostTiles || *rows > kMostTiles ||
      (has_rows && *rows < 1)) {
    return fail(ErrorKind::kInput,
                "--sheet {}: expected columns and rows, such as 6x4, or columns alone, such as 6",
                text);
  }
  const auto each = static_cast<std::int64_t>(tiles);
  if (*rows % each != 0) {
    return fail(
        ErrorKind::kInput,
        "--sheet {}: each frame has {} tiles, below each other: the rows must be a multiple "
        "of {}",
        text, each, each);
  }
  return SheetShape{static_cast<int>(*columns), static_cast<int>(*rows)};
}

/// Of "7", "0-11" and "all", in that order.
Result<std::vector<std::int64_t>> parse_frames(const std::vector<std::string>& texts,
                                               std::int64_t total) {
  std::vector<std::int64_t> frames;
  for (const std::string& text : texts) {
    const std::size_t dash = std::min(text.find('-'), text.size());
    const auto first = text == "all" ? 0 : number_of(std::string_view(text).substr(0, dash));
    const auto last = text == "all"         ? std::max<std::int64_t>(total, 1) - 1
                      : dash == text.size() ? first
                                            : number_of(std::string_view(text).substr(dash + 1));
    if (!first || !last || *first > *last) {
      return fail(ErrorKind::kInput,
                  "'{}' is no frame: expected an index from 0, a range such as 0-11, or all", text);
    }
    if (*last >= total) {
      return fail(ErrorKind::kInput, "there is no frame {}: the campaign has frames 0 to {}", *last,
                  total - 1);
    }
    if (*last - *first + static_cast<std::int64_t>(frames.size()) >= kMostTiles) {
      return fail(ErrorKind::kInput, "a picture shows up to {} frames, '{}' asks for more",
                  kMostTiles, text);
    }
    for (std::int64_t frame = *first; frame <= *last; ++frame) frames.push_back(frame);
  }
  return frames;
}

/// Of the working directory: of the campaign's name, and the frame's if it is only one.
fs::path usual_output(const fs::path& folder, const std::vector<std::int64_t>& frames) {
  std::error_code error;
  fs::path name = fs::weakly_canonical(folder, error).filename();
  if (name.empty()) name = "campaign";
  return frames.size() == 1 ? fmt::format("{}-frame-{}.png", name.string(), frames[0])
                            : name.string() + ".png";
}

Result<std::vector<std::int64_t>> frames_for(const Campaign& campaign,
                                             const ShowArguments& arguments,
                                             const SheetShape& shape, std::size_t tiles) {
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return forward_error(counts);
  if (!arguments.frames.empty()) return parse_frames(arguments.frames, counts->total());
  const std::int64_t most =
      shape.rows > 0 ? std::min<std::int64_t>(kMostTiles, std::int64_t{shape.columns} * shape.rows /
                                                              static_cast<std::int64_t>(tiles))
                     : kUsualFrames;
  auto frames = frames_worth_showing(campaign, most);
  if (frames && frames->empty()) {
    return fail(ErrorKind::kInput,
                "{}: none of its {} frames is there yet: 'seedframe resume {}' makes them",
                arguments.folder, counts->total(), arguments.folder);
  }
  return frames;
}

/// What the twin is traced from: the config is read when a frame is first asked for.
FrameExpansion expansion_of(const Campaign& campaign, const ShowArguments& arguments) {
  auto prepared = std::make_shared<std::optional<Result<PreparedCampaign>>>();
  return [&campaign, &arguments, prepared](std::int64_t frame) -> Result<ExpandedFrame> {
    if (!*prepared) {
      prepared->emplace(prepare_again(campaign, seedframe_home(), arguments.allowed));
    }
    const Result<PreparedCampaign>& ready = **prepared;
    if (!ready) {
      return fail(ErrorKind::kInput, "The twin is traced from the config, which cannot be read: {}",
                  ready.error().message);
    }
    return ready->expander.expand(frame);
  };
}

int draw(const Campaign& campaign, const Dataset& dataset, SheetWish wish,
         const ShowArguments& arguments) {
  const fs::path output = arguments.output.empty() ? usual_output(arguments.folder, wish.frames)
                                                   : fs::path(arguments.output);
  if (Status possible = check_picture_file(output, arguments.overwrite); !possible) {
    return report(possible.error());
  }
  const Result<CampaignSheet> made =
      make_sheet(campaign, dataset, wish, expansion_of(campaign, arguments));
  if (!made) return report(made.error());
  const auto picture = draw_sheet(made->sheet);
  if (!picture) return report(picture.error());
  if (Status written = write_picture(*picture, output, arguments.overwrite); !written) {
    return report(written.error());
  }
  std::string tiles;
  for (const LayerSet& tile : wish.tiles) tiles += (tiles.empty() ? "" : ", ") + tile.name();
  say("{}: {}, {} ({} × {} pixels)\n", output.string(),
      wish.frames.size() == 1 ? fmt::format("frame {}", wish.frames[0])
                              : fmt::format("{} frames", wish.frames.size()),
      tiles, picture->width, picture->height);
  for (const std::string& complaint : made->complaints) {
    say_aside("seedframe: note: {}\n", complaint);
  }
  if (arguments.open) open_file(output);
  return made->any_corrupt ? kExitCorrupt : kExitOk;
}

int show(const ShowArguments& arguments) {
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  std::optional<std::vector<LayerSet>> tiles;
  if (!arguments.layers.empty()) {
    auto parsed = parse_layers(arguments.layers);
    if (!parsed) return report(parsed.error());
    tiles = std::move(*parsed);
  }
  const auto shape = parse_shape(arguments.sheet, tiles ? tiles->size() : 1);
  if (!shape) return report(shape.error());
  SheetWish wish;
  const auto frames = frames_for(*campaign, arguments, *shape, tiles ? tiles->size() : 1);
  if (!frames) return report(frames.error());
  wish.frames = *frames;
  wish.columns = shape->columns;
  wish.tile_width = arguments.tile_width;
  wish.plain = arguments.plain;
  Result<KeptInputs> inputs = inputs_of(*campaign, seedframe_home(), arguments.allowed);
  if (!inputs) return report(inputs.error());
  const Result<CampaignDataset> dataset = campaign_dataset(*campaign, std::move(*inputs));
  if (!dataset) return report(dataset.error());
  wish.tiles = tiles ? std::move(*tiles) : usual_tiles(dataset->dataset, wish.frames.size());
  return draw(*campaign, dataset->dataset, std::move(wish), arguments);
}

std::string layers_help() {
  std::string names;
  for (const char* name : kLayerNames) names += (names.empty() ? "" : ", ") + std::string(name);
  return "what a tile shows: layers joined by + lie over each other, a comma begins another tile "
         "of "
         "the frame; of " +
         names;
}

}  // namespace

void add_show_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<ShowArguments>();
  CLI::App* verb =
      app.add_subcommand("show", "a picture of frames and their labels: one frame, or a sheet");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  verb->add_option("FRAME", arguments->frames,
                   "indices from 0, ranges such as 0-11, or all (default: 12 frames, spread over "
                   "those that are there)");
  verb->add_option("-o,--output", arguments->output,
                   "the picture, .png or .jpg (default: <name of the campaign>.png here)")
      ->type_name("FILE");
  verb->add_option("--layers", arguments->layers, layers_help())
      ->type_name("LAYERS")
      ->check(offers({kLayerNames.begin(), kLayerNames.end()}));
  verb->add_option("--sheet", arguments->sheet,
                   "columns and rows of tiles, such as 6x4, or columns alone, such as 6")
      ->type_name("COLUMNSxROWS");
  verb->add_option("--tile-width", arguments->tile_width,
                   "pixels of a tile, at most (default: 320, and 640 for a single frame)")
      ->check(CLI::Range(16, 8192));
  verb->add_flag("--plain", arguments->plain, "tiles alone: no title, captions or legend");
  verb->add_flag("--overwrite", arguments->overwrite,
                 "also where there is a file that Seedframe did not draw");
  verb->add_flag("--open", arguments->open, "show it on the screen");
  add_allow_option(*verb, arguments->allowed);
  verb->footer(
      "Example: seedframe show results/parts --sheet 6x4 --layers image,instances -o sheet.png");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return show(*arguments); }); });
}

}  // namespace seedframe
