#include "preview/shading_images.h"

#include "preview/linear_image.h"

namespace seedframe {
namespace {

// Of the longer side: previews are small.
constexpr int kMostTexturePx = 1024;      // 4 MB with its halves
constexpr int kMostEnvironmentPx = 2048;  // 25 MB

template <class Value>
Result<Value> read(const HashedFile& file, int most_px) {
  Result<Image<float>> light = read_linear_image(file.path, most_px);
  if (!light) return forward_error(light);
  return Value(std::move(*light));
}

}  // namespace

Result<std::shared_ptr<const Texture>> ShadingImages::texture(const HashedFile& file) {
  return textures_.get(file.sha256, [&] { return read<Texture>(file, kMostTexturePx); });
}

Result<std::shared_ptr<const EnvironmentMap>> ShadingImages::environment(const HashedFile& file) {
  return environments_.get(file.sha256,
                           [&] { return read<EnvironmentMap>(file, kMostEnvironmentPx); });
}

}  // namespace seedframe
