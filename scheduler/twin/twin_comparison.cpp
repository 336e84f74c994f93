#include "twin/twin_comparison.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace seedframe {
namespace {

using Ids = Image<std::uint16_t>;

constexpr std::int64_t kAlwaysAllowed = 8;
constexpr std::size_t kIds = 65536;

bool near(const Ids& image, int row, int column, std::uint16_t id) {
  for (int y = std::max(0, row - 1); y <= std::min(image.height - 1, row + 1); ++y) {
    for (int x = std::max(0, column - 1); x <= std::min(image.width - 1, column + 1); ++x) {
      if (image.at(y, x) == id) return true;
    }
  }
  return false;
}

enum class Difference : std::uint8_t { kNone = 0, kCoincident = 64, kEdge = 128, kInside = 255 };

/// At an edge each image has the other's id beside the pixel; or it is a glimpse of something that
/// is smaller than a pixel.
Difference difference(const Ids& rendered, const Ids& twin, int row, int column,
                      const Rounding& rounding) {
  const std::uint16_t r = rendered.at(row, column);
  const std::uint16_t t = twin.at(row, column);
  if (r == t) return Difference::kNone;
  if (rounding.coincides && rounding.coincides(row, column, r)) return Difference::kCoincident;
  const bool edge = near(rendered, row, column, t) && near(twin, row, column, r);
  const bool grazed = rounding.grazes && rounding.grazes(row, column, r);
  return edge || grazed ? Difference::kEdge : Difference::kInside;
}

/// Pixels of one id.
struct IdTally {
  std::int64_t rendered = 0;
  std::int64_t traced = 0;
  std::int64_t outline = 0;  ///< of the twin's pixels, those with another id on a side
  std::int64_t differing = 0;
};

bool on_outline(const Ids& image, int row, int column) {
  const std::uint16_t id = image.at(row, column);
  return (row > 0 && image.at(row - 1, column) != id) ||
         (row + 1 < image.height && image.at(row + 1, column) != id) ||
         (column > 0 && image.at(row, column - 1) != id) ||
         (column + 1 < image.width && image.at(row, column + 1) != id);
}

/// By id. Called only for images that differ, which are few.
std::vector<IdTally> tally_ids(const Ids& rendered, const Ids& twin,
                               const Image<std::uint8_t>& differences) {
  std::vector<IdTally> tallies(kIds);
  for (int row = 0; row < twin.height; ++row) {
    for (int column = 0; column < twin.width; ++column) {
      const std::uint16_t r = rendered.at(row, column);
      const std::uint16_t t = twin.at(row, column);
      ++tallies[r].rendered;
      ++tallies[t].traced;
      if (on_outline(twin, row, column)) ++tallies[t].outline;
      const auto found = static_cast<Difference>(differences.at(row, column));
      if (found == Difference::kNone || found == Difference::kCoincident) continue;
      ++tallies[r].differing;
      ++tallies[t].differing;
    }
  }
  return tallies;
}

/// "instance 'bolt/3' (id 7): 214 of its 1034 pixels differ, and it is not in the picture at all"
std::string describe(const FrameSpec& spec, std::size_t id, const IdTally& tally) {
  std::string text = "the background";
  for (const InstanceSpec& instance : spec.instances) {
    if (instance.id == static_cast<int>(id) && id != 0) {
      text = fmt::format("instance '{}' (id {})", instance.name, id);
    }
  }
  text += fmt::format(": {} pixels differ; {} in the picture, {} in the twin, {} of them outline",
                      tally.differing, tally.rendered, tally.traced, tally.outline);
  if (tally.rendered == 0) text += "; it is missing from the picture";
  if (tally.traced == 0) text += "; the twin does not see it";
  return text;
}

/// The id with the most differing pixels; the background only if there is no other.
std::size_t worst_id(const std::vector<IdTally>& tallies) {
  const auto worst = std::max_element(
      tallies.begin() + 1, tallies.end(),
      [](const IdTally& a, const IdTally& b) { return a.differing < b.differing; });
  return worst->differing == 0 ? 0 : static_cast<std::size_t>(worst - tallies.begin());
}

constexpr const char* kHint =
    "so the worker did not render what the frame spec says (a wrong transform, camera or mesh, or "
    "a missing object)";

}  // namespace

Rounding rounding_of(const Twin& twin) {
  return {[&](int row, int column, std::uint16_t id) { return twin.grazes(row, column, id); },
          [&](int row, int column, std::uint16_t id) { return twin.coincides(row, column, id); }};
}

TwinVerdict compare_with_twin(const FrameSpec& spec, const Ids& rendered, const Ids& twin,
                              const TwinTolerance& tolerance, const Rounding& rounding) {
  assert(rendered.width == twin.width && rendered.height == twin.height);
  TwinVerdict verdict;
  TwinTally& tally = verdict.tally;
  tally.pixels = static_cast<std::int64_t>(twin.values.size());
  if (rendered.values == twin.values) return verdict;
  const Image<std::uint8_t> differences = difference_image(rendered, twin, rounding);
  for (const std::uint8_t value : differences.values) {
    const auto found = static_cast<Difference>(value);
    if (found == Difference::kEdge || found == Difference::kCoincident) ++tally.edge_px;
    if (found == Difference::kInside) ++tally.inside_px;
  }
  const std::vector<IdTally> tallies = tally_ids(rendered, twin, differences);
  const double allowed = tolerance.inside_share * static_cast<double>(tally.pixels);
  if (static_cast<double>(tally.inside_px) > allowed) {
    const std::size_t worst = worst_id(tallies);
    verdict.complaint = fmt::format(
        "{} of {} pixels of the index pass are not what the twin sees, edges apart "
        "({} are allowed), {}; most in {}",
        tally.inside_px, tally.pixels, std::floor(allowed), kHint,
        describe(spec, worst, tallies[worst]));
    return verdict;
  }
  for (std::size_t id = 1; id < kIds; ++id) {
    const IdTally& of_id = tallies[id];
    const double most = std::max(static_cast<double>(kAlwaysAllowed),
                                 tolerance.outline_share * static_cast<double>(of_id.outline));
    if (static_cast<double>(of_id.differing) <= most) continue;
    verdict.complaint = fmt::format("an outline is not where the twin sees it, {}; {}", kHint,
                                    describe(spec, id, of_id));
    return verdict;
  }
  return verdict;
}

Image<std::uint8_t> difference_image(const Ids& rendered, const Ids& twin,
                                     const Rounding& rounding) {
  Image<std::uint8_t> image(twin.width, twin.height);
  for (int row = 0; row < twin.height; ++row) {
    for (int column = 0; column < twin.width; ++column) {
      image.at(row, column) =
          static_cast<std::uint8_t>(difference(rendered, twin, row, column, rounding));
    }
  }
  return image;
}

}  // namespace seedframe
