#include "spec/rendering_wish.h"

#include <array>

namespace seedframe {
namespace {

constexpr int kMostSamples = 1 << 16;

tl::unexpected<Error> wrong_crop() {
  return fail(ErrorKind::kInput, "crop: expected [x, y, width, height] in pixels of the image");
}

Status take_samples(const Json& value, RenderingWish& wish) {
  const auto samples = integer_in<int>(value);
  if (!samples || *samples < 1 || *samples > kMostSamples) {
    return fail(ErrorKind::kInput, "samples: expected a whole number from 1 to {}", kMostSamples);
  }
  wish.samples = *samples;
  return {};
}

Status take_crop(const Json& value, RenderingWish& wish) {
  std::array<int, 4> numbers{};
  if (!value.is_array() || value.size() != numbers.size()) return wrong_crop();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = integer_in<int>(value[i]);
    if (!number || *number < 0 || (i > 1 && *number == 0)) return wrong_crop();
    numbers[i] = *number;
  }
  wish.crop = PixelRect{numbers[0], numbers[1], numbers[2], numbers[3]};
  return {};
}

Status take(const std::string& key, const Json& value, RenderingWish& wish) {
  if (key == "samples") return take_samples(value, wish);
  if (key == "crop") return take_crop(value, wish);
  if (!value.is_boolean()) return fail(ErrorKind::kInput, "{}: expected true or false", key);
  if (key == "denoise") {
    wish.denoise = value.get<bool>();
  } else {
    wish.depth = value.get<bool>();
  }
  return {};
}

}  // namespace

Result<bool> take_rendering_wish(const std::string& key, const Json& value, RenderingWish& wish) {
  if (key != "samples" && key != "denoise" && key != "crop" && key != "depth") return false;
  if (Status taken = take(key, value, wish); !taken) return forward_error(taken);
  return true;
}

Json to_json(const RenderingWish& wish) {
  Json json = Json::object();
  if (wish.samples) json["samples"] = *wish.samples;
  if (wish.denoise) json["denoise"] = *wish.denoise;
  if (wish.crop) json["crop"] = {wish.crop->x, wish.crop->y, wish.crop->width, wish.crop->height};
  if (wish.depth) json["depth"] = true;
  return json;
}

Status apply(const RenderingWish& wish, RenderSettings& render) {
  if (wish.samples) render.samples = *wish.samples;
  if (wish.denoise && !*wish.denoise) render.denoise = Denoise::kOff;
  if (wish.denoise && *wish.denoise && render.denoise == Denoise::kOff) {
    render.denoise = Denoise::kOidn;
  }
  if (wish.depth) render.depth = true;
  if (!wish.crop) return {};
  // Each alone first: their sum may be beyond an int.
  const PixelRect& crop = *wish.crop;
  if (crop.x >= render.width || crop.width > render.width - crop.x || crop.y >= render.height ||
      crop.height > render.height - crop.y) {
    return fail(ErrorKind::kInput, "crop: it reaches beyond the image of {} × {} pixels",
                render.width, render.height);
  }
  render.region = crop;
  return {};
}

}  // namespace seedframe
