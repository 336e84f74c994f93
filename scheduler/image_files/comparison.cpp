#include "image_files/comparison.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "image_files/image_module.h"

namespace seedframe {
namespace {

/// The module only reads through it.
image_module::FloatPixels pixels_of(const Image<float>& image) {
  return {image.width, image.height, image.channels, const_cast<float*>(image.values.data())};
}

}  // namespace

double ImageErrors::psnr_db(double peak) const {
  return rms > 0.0 ? 20.0 * std::log10(peak / rms) : std::numeric_limits<double>::infinity();
}

Result<ImageErrors> errors_between(const Image<float>& a, const Image<float>& b) {
  assert(a.width == b.width && a.height == b.height && a.channels == b.channels);
  const Result<const image_module::Table*> library = image_module_table();
  if (!library) return forward_error(library);
  const image_module::FloatPixels left = pixels_of(a);
  const image_module::FloatPixels right = pixels_of(b);
  image_module::Errors errors;
  image_module::Fault fault;
  if (!(*library)->compare(&left, &right, &errors, &fault)) {
    return fail(ErrorKind::kEnvironment, "cannot compare images: {}", fault.text);
  }
  return ImageErrors{errors.max, errors.mean, errors.rms};
}

}  // namespace seedframe
