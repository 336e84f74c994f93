#include <algorithm>
#include <memory>

#include <OpenImageIO/filter.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "image_files/plugin/calls.h"

namespace seedframe::image_module {
namespace {

/// The memory of `pixels`, not a copy.
OIIO::ImageBuf buffer_of(const FloatPixels& pixels) {
  const OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels, OIIO::TypeFloat);
  return OIIO::ImageBuf(spec, pixels.values);
}

using Filter = std::unique_ptr<OIIO::Filter1D, void (*)(OIIO::Filter1D*)>;

/// The library counts a filter's width in pixels of the result.
Filter filter_of(const char* name, int from, int to) {
  for (int i = 0; i < OIIO::Filter1D::num_filters(); ++i) {
    const OIIO::FilterDesc& known = OIIO::Filter1D::get_filterdesc(i);
    if (std::string(known.name) != name) continue;
    const float ratio = std::max(1.0F, static_cast<float>(to) / static_cast<float>(from));
    return {OIIO::Filter1D::create(name, known.width * ratio), OIIO::Filter1D::destroy};
  }
  return {nullptr, OIIO::Filter1D::destroy};
}

class FilterOfTwo : public OIIO::Filter2D {
 public:
  FilterOfTwo(const OIIO::Filter1D& across, const OIIO::Filter1D& down)
      : Filter2D(across.width(), down.width()), across_(across), down_(down) {}

  OIIO::string_view name() const override { return "across and down"; }
  bool separable() const override { return true; }
  float operator()(float x, float y) const override { return across_(x) * down_(y); }
  float xfilt(float x) const override { return across_(x); }
  float yfilt(float y) const override { return down_(y); }

 private:
  const OIIO::Filter1D& across_;
  const OIIO::Filter1D& down_;
};

}  // namespace

bool resize_image(const FloatPixels* from, const FloatPixels* to, const char* filter_across,
                  const char* filter_down, Fault* fault) {
  return guarded(fault, [&] {
    const Filter across = filter_of(filter_across, from->width, to->width);
    const Filter down = filter_of(filter_down, from->height, to->height);
    if (across == nullptr || down == nullptr) {
      return refuse(fault, std::string("this OpenImageIO lacks the filter ") +
                               (across == nullptr ? filter_across : filter_down));
    }
    FilterOfTwo filter(*across, *down);
    const OIIO::ImageBuf source = buffer_of(*from);
    OIIO::ImageBuf result = buffer_of(*to);
    const bool done = OIIO::ImageBufAlgo::resize(result, source, &filter, OIIO::ROI::All(), 1);
    return done || refuse(fault, result.geterror());
  });
}

}  // namespace seedframe::image_module
