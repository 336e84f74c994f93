// What the camera model does to pictures whose light is known.

#include "sensor/camera_sensor.h"

#include <cmath>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

Image<std::uint8_t> flat(int code, int side = 128) {
  Image<std::uint8_t> image(side, side, 3);
  for (std::uint8_t& value : image.values) value = static_cast<std::uint8_t>(code);
  return image;
}

/// Every code in every channel, beside others.
Image<std::uint8_t> all_codes() {
  Image<std::uint8_t> image(256, 3, 3);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 256; ++column) {
      for (int channel = 0; channel < 3; ++channel) {
        image.at(row, column, channel) =
            static_cast<std::uint8_t>((column * (row + 1) + 85 * channel) % 256);
      }
    }
  }
  return image;
}

double light_of(int code) {
  const double v = code / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};

/// Of one channel's light, as a share of white.
Moments moments_of(const Image<std::uint8_t>& image, int channel) {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = static_cast<std::size_t>(channel); i < image.values.size(); i += 3) {
    const double light = light_of(image.values[i]);
    sum += light;
    squares += light * light;
    count += 1.0;
  }
  return {sum / count, std::sqrt(squares / count - sum / count * sum / count)};
}

Image<std::uint8_t> taken(const Image<std::uint8_t>& image, const SensorSettings& sensor) {
  const auto result = through_sensor(image, sensor);
  EXPECT_TRUE(result) << result.error().message;
  return result.value_or(Image<std::uint8_t>());
}

TEST(CameraSensor, ChangesNothingWhenAllIsOff) {
  const Image<std::uint8_t> image = all_codes();
  EXPECT_EQ(taken(image, {}).values, image.values);
}

TEST(CameraSensor, AStopOfExposureDoublesTheLight) {
  for (const int code : {20, 90, 150}) {
    const Moments brighter = moments_of(taken(flat(code), {.exposure_stops = 1.0}), 1);
    EXPECT_NEAR(brighter.mean, 2.0 * light_of(code), 0.006);
    const Moments darker = moments_of(taken(flat(code), {.exposure_stops = -1.0}), 1);
    EXPECT_NEAR(darker.mean, 0.5 * light_of(code), 0.003);
  }
  EXPECT_EQ(taken(flat(220), {.exposure_stops = 3.0}).values, flat(255).values);
}

TEST(CameraSensor, WhiteBalanceScalesEachChannel) {
  const auto image = taken(flat(120), {.white_balance = {0.5, 1.0, 1.5}});
  EXPECT_NEAR(moments_of(image, 0).mean, 0.5 * light_of(120), 0.002);
  EXPECT_EQ(image.at(0, 0, 1), 120);
  EXPECT_NEAR(moments_of(image, 2).mean, 1.5 * light_of(120), 0.004);
}

TEST(CameraSensor, NoiseIsShotNoiseAndReadNoise) {
  constexpr double kFullWell = 2'000.0;
  constexpr double kReadNoise = 12.0;
  for (const int code : {60, 128, 200}) {
    const auto image =
        taken(flat(code, 256), {.full_well = kFullWell, .read_noise = kReadNoise, .seed = 7});
    const double electrons = light_of(code) * kFullWell;
    const double deviation = std::sqrt(electrons + kReadNoise * kReadNoise) / kFullWell;
    for (int channel = 0; channel < 3; ++channel) {
      const Moments moments = moments_of(image, channel);
      // 65,536 pixels: 0.4 % of the deviation each way; more for the rounding to codes.
      EXPECT_NEAR(moments.mean, light_of(code), 0.02 * deviation + 1e-4) << code;
      EXPECT_NEAR(moments.deviation, deviation, 0.03 * deviation) << code;
    }
  }
}

TEST(CameraSensor, NoiseOfPixelsAndChannelsIsIndependent) {
  const auto image = taken(flat(128, 256), {.full_well = 500.0, .seed = 3});
  const double mean = moments_of(image, 0).mean;
  const auto correlation = [&](int right, int down, int channel) {
    double product = 0.0;
    double square = 0.0;
    for (int row = 0; row + down < 256; ++row) {
      for (int column = 0; column + right < 256; ++column) {
        const double a = light_of(image.at(row, column, 0)) - mean;
        product += a * (light_of(image.at(row + down, column + right, channel)) - mean);
        square += a * a;
      }
    }
    return product / square;
  };
  EXPECT_NEAR(correlation(0, 0, 0), 1.0, 1e-9);
  EXPECT_NEAR(correlation(0, 0, 1), 0.0, 0.02);
  EXPECT_NEAR(correlation(0, 0, 2), 0.0, 0.02);
  EXPECT_NEAR(correlation(1, 0, 0), 0.0, 0.02);
  EXPECT_NEAR(correlation(0, 1, 0), 0.0, 0.02);
}

TEST(CameraSensor, TheSameSeedIsTheSamePictureAndAnotherIsNot) {
  const SensorSettings sensor = {
      .blur_px = 0.7, .full_well = 3'000.0, .read_noise = 5.0, .seed = 11};
  SensorSettings other = sensor;
  other.seed = 12;
  const Image<std::uint8_t> image = all_codes();
  EXPECT_EQ(taken(image, sensor).values, taken(image, sensor).values);
  EXPECT_NE(taken(image, sensor).values, taken(image, other).values);
}

TEST(CameraSensor, NoiseIsWhatItHasAlwaysBeen) {
  const auto image = taken(flat(128, 2), {.full_well = 100.0, .read_noise = 3.0, .seed = 5});
  EXPECT_EQ(image.values,
            (std::vector<std::uint8_t>{121, 144, 121, 134, 134, 128, 149, 106, 78, 147, 138, 121}));
}

TEST(CameraSensor, BlurSpreadsLightAndKeepsIt) {
  Image<std::uint8_t> dot = flat(0, 65);
  for (int channel = 0; channel < 3; ++channel) dot.at(32, 32, channel) = 255;
  const auto image = taken(dot, {.blur_px = 1.0, .exposure_stops = 1.0});
  double sum = 0.0;
  for (int row = 0; row < 65; ++row) {
    for (int column = 0; column < 65; ++column) sum += light_of(image.at(row, column, 0));
  }
  EXPECT_NEAR(sum, 2.0, 0.03);
  // exp(-r² / 2) / 2π
  EXPECT_NEAR(light_of(image.at(32, 32, 0)), 2.0 * 0.1592, 0.01);
  EXPECT_NEAR(light_of(image.at(32, 33, 0)), 2.0 * 0.0965, 0.01);
  EXPECT_EQ(image.at(32, 33, 0), image.at(31, 32, 0));
  EXPECT_EQ(taken(flat(77), {.blur_px = 5.0}).values, flat(77).values);
}

TEST(CameraSensor, AJpegIsNearlyThePicture) {
  Image<std::uint8_t> image(64, 64, 3);
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) {
      for (int channel = 0; channel < 3; ++channel) {
        image.at(row, column, channel) = static_cast<std::uint8_t>(2 * row + column + 20 * channel);
      }
    }
  }
  const auto worst = [&](int quality) {
    int most = 0;
    const auto coded = taken(image, {.jpeg_quality = quality});
    for (std::size_t i = 0; i < image.values.size(); ++i) {
      most = std::max(most, std::abs(int{coded.values[i]} - int{image.values[i]}));
    }
    return most;
  };
  EXPECT_GT(worst(90), 0);
  EXPECT_LE(worst(90), 12);
  EXPECT_GT(worst(5), worst(90));
}

}  // namespace
}  // namespace seedframe
