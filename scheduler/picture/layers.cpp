#include "picture/layers.h"

#include <algorithm>

#include "base/nearest_name.h"

namespace seedframe {
namespace {

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char letter : text) {
    if (letter == separator) {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

/// Layers that fill the whole tile: only one can be seen.
constexpr std::array<Layer, 3> kOpaqueLayers = {Layer::kImage, Layer::kDepth, Layer::kNormals};

}  // namespace

LayerSet LayerSet::with(const LayerSet& other) const {
  LayerSet both = *this;
  both.set_ |= other.set_;
  return both;
}

std::string LayerSet::name() const {
  std::string name;
  for (std::size_t i = 0; i < kLayerCount; ++i) {
    if (set_.test(i)) name += (name.empty() ? "" : "+") + std::string(kLayerNames[i]);
  }
  return name;
}

Result<std::vector<LayerSet>> parse_layers(const std::string& text) {
  const std::vector<std::string> known(kLayerNames.begin(), kLayerNames.end());
  std::vector<LayerSet> tiles;
  for (const std::string& tile : parts_of(text, ',')) {
    LayerSet& layers = tiles.emplace_back();
    for (const std::string& name : parts_of(tile, '+')) {
      const auto found = std::find(known.begin(), known.end(), name);
      if (found == known.end()) {
        return fail(ErrorKind::kInput, "--layers {}: there is no layer '{}'{}", text, name,
                    did_you_mean(name, known));
      }
      layers.add(static_cast<Layer>(found - known.begin()));
    }
    const auto opaque = std::count_if(kOpaqueLayers.begin(), kOpaqueLayers.end(),
                                      [&](Layer layer) { return layers.has(layer); });
    if (opaque > 1) {
      return fail(ErrorKind::kInput,
                  "--layers {}: of image, depth and normals a tile shows one, '{}' has {}: a comma "
                  "in place of a + makes tiles of their own",
                  text, tile, opaque);
    }
  }
  return tiles;
}

}  // namespace seedframe
