// A camera model over finished pictures: what a sensor adds to them, and takes away.
#pragma once

#include <cstdint>

#include "base/error.h"
#include "image/image.h"
#include "spec/sensor_settings.h"

namespace seedframe {

/// The 8-bit sRGB picture as a camera with these settings has it. Pixels are taken for light by the
/// sRGB curve (IEC 61966-2-1), blurred, exposed, counted as electrons with shot noise and read
/// noise, balanced, cut at white, and coded again; at last as a JPEG, if there is a quality. A pure
/// function, the same on every machine (JPEG: with the same libjpeg). kEnvironment error: JPEG
/// needs the image module (image_files/image_module.h).
///
/// Shot noise is normally distributed here, of deviation √electrons: from some ten electrons on,
/// which is a thousandth of white in most cameras, nobody could tell it from Poisson's.
Result<Image<std::uint8_t>> through_sensor(const Image<std::uint8_t>& picture,
                                           const SensorSettings& sensor);

}  // namespace seedframe
