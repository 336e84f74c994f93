// What may be shown of a frame.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

/// In the order in which they are painted over each other.
enum class Layer {
  kImage,
  kDepth,
  kNormals,
  kSemantic,      ///< masks in the colours of their classes
  kInstances,     ///< masks, each instance in a shade of its class's colour
  kDisagreement,  ///< pixels of another instance than the twin sees there
  kAmodal,        ///< outlines of whole objects, also behind others
  kBoxes,
  kKeypoints,
  kNames,  ///< of classes
};
inline constexpr std::array<const char*, 10> kLayerNames = {
    "image",        "depth",  "normals", "semantic",  "instances",
    "disagreement", "amodal", "boxes",   "keypoints", "names"};
inline constexpr std::size_t kLayerCount = kLayerNames.size();

/// Layers over each other: one tile of a sheet, one panel of a frame.
class LayerSet {
 public:
  LayerSet() = default;
  LayerSet(std::initializer_list<Layer> layers) {
    for (const Layer layer : layers) set_.set(static_cast<std::size_t>(layer));
  }

  bool has(Layer layer) const { return set_.test(static_cast<std::size_t>(layer)); }
  void add(Layer layer) { set_.set(static_cast<std::size_t>(layer)); }
  LayerSet with(const LayerSet& other) const;
  /// "image+boxes+names".
  std::string name() const;

  bool operator==(const LayerSet&) const = default;

 private:
  std::bitset<kLayerCount> set_;
};

/// Of "image+boxes+names,instances": a tile for each part between commas. kInput error: a name that
/// is no layer, a tile of nothing, or of two pictures that would cover each other.
Result<std::vector<LayerSet>> parse_layers(const std::string& text);

}  // namespace seedframe
