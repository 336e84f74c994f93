#include "image/png_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using testing::HasSubstr;

// Values that differ from pixel to pixel, the same on every machine.
template <class T>
Image<T> textured(int width, int height, int channels) {
  Image<T> image(width, height, channels);
  std::uint32_t state = 1;
  for (T& value : image.values) {
    state = state * 1664525U + 1013904223U;
    value = static_cast<T>(state >> 16);
  }
  return image;
}

TEST(PngFile, ALevelChangesBytesAndNoPixel) {
  Image<std::uint8_t> image(64, 48, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<std::uint8_t>(i / 64 % 7);
  }
  const std::string stored = encode_png(image, PngContent::kPhoto, 0);
  const std::string smallest = encode_png(image, PngContent::kPhoto, 9);
  EXPECT_GT(stored.size(), image.values.size());
  EXPECT_LT(smallest.size(), encode_png(image).size());
  for (const std::string& bytes : {stored, smallest}) {
    EXPECT_EQ(decode_png8(bytes, "it")->values, image.values);
  }
}

TEST(PngFile, EightBitGreyComesBack) {
  const ScratchFolder folder;
  const auto image = textured<std::uint8_t>(17, 5, 1);
  ASSERT_TRUE(write_file(folder / "a.png", encode_png(image)));
  const auto back = read_png8(folder / "a.png");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->width, 17);
  EXPECT_EQ(back->height, 5);
  EXPECT_EQ(back->channels, 1);
  EXPECT_EQ(back->values, image.values);
}

TEST(PngFile, RgbComesBack) {
  const ScratchFolder folder;
  const auto image = textured<std::uint8_t>(5, 17, 3);
  ASSERT_TRUE(write_file(folder / "a.png", encode_png(image)));
  const auto back = read_png8(folder / "a.png");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->channels, 3);
  EXPECT_EQ(back->values, image.values);
}

TEST(PngFile, SixteenBitIdsComeBackExactly) {
  const ScratchFolder folder;
  Image<std::uint16_t> ids(4, 2);
  ids.values = {0, 1, 255, 256, 257, 32767, 65534, 65535};
  ASSERT_TRUE(write_file(folder / "a.png", encode_png(ids)));
  const auto back = read_png16(folder / "a.png");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->values, ids.values);
}

TEST(PngFile, ALargeFlatPictureComesBack) {
  const ScratchFolder folder;
  const Image<std::uint16_t> empty(2000, 1500);
  ASSERT_TRUE(write_file(folder / "a.png", encode_png(empty)));
  const auto back = read_png16(folder / "a.png");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->values, empty.values);
}

TEST(PngFile, TheSamePixelsGiveTheSameBytes) {
  const auto image = textured<std::uint8_t>(64, 48, 3);
  EXPECT_EQ(encode_png(image), encode_png(image));
}

TEST(PngFile, HoldsNothingButThePicture) {
  const std::string grey = encode_png(textured<std::uint16_t>(4, 4, 1));
  const std::string color = encode_png(textured<std::uint8_t>(4, 4, 3));
  for (const char* chunk : {"tIME", "tEXt", "zTXt", "iTXt", "gAMA", "pHYs"}) {
    EXPECT_EQ(grey.find(chunk), std::string::npos) << chunk;
    EXPECT_EQ(color.find(chunk), std::string::npos) << chunk;
  }
  EXPECT_EQ(grey.find("sRGB"), std::string::npos);
  EXPECT_NE(color.find("sRGB"), std::string::npos);
}

TEST(PngFile, EveryTruncationIsAnErrorThatNamesTheFile) {
  const ScratchFolder folder;
  const std::string whole = encode_png(textured<std::uint8_t>(9, 7, 3));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    ASSERT_TRUE(write_file(folder / "cut.png", std::string_view(whole).substr(0, length)));
    const auto image = read_png8(folder / "cut.png");
    ASSERT_FALSE(image) << length << " of " << whole.size() << " bytes";
    EXPECT_EQ(image.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(image.error().message, HasSubstr("cut.png"));
  }
}

TEST(PngFile, EveryFlippedByteIsAnError) {
  const ScratchFolder folder;
  const std::string whole = encode_png(textured<std::uint16_t>(6, 5, 1));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(~flipped[at]);
    ASSERT_TRUE(write_file(folder / "flipped.png", flipped));
    EXPECT_FALSE(read_png16(folder / "flipped.png")) << "byte " << at;
  }
}

TEST(PngFile, BytesBehindTheEndAreAnError) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a.png", encode_png(Image<std::uint8_t>(2, 2)) + "x"));
  const auto image = read_png8(folder / "a.png");
  ASSERT_FALSE(image);
  EXPECT_THAT(image.error().message, HasSubstr("bytes follow its end"));
}

TEST(PngFile, AnotherDepthIsAnErrorThatSaysWhatWasFound) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "8.png", encode_png(Image<std::uint8_t>(2, 2))));
  ASSERT_TRUE(write_file(folder / "16.png", encode_png(Image<std::uint16_t>(2, 2))));
  ASSERT_TRUE(write_file(folder / "rgb.png", encode_png(Image<std::uint8_t>(2, 2, 3))));
  EXPECT_THAT(read_png16(folder / "8.png").error().message,
              HasSubstr("expected grey with 16 bits a channel, found grey with 8"));
  EXPECT_THAT(read_png8(folder / "16.png").error().message,
              HasSubstr("expected grey or RGB with 8 bits a channel, found grey with 16"));
  EXPECT_THAT(read_png16(folder / "rgb.png").error().message, HasSubstr("found RGB with 8"));
}

TEST(PngFile, AMissingFileIsAnError) {
  const ScratchFolder folder;
  const auto image = read_png8(folder / "none.png");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(image.error().message, HasSubstr("none.png"));
}

// A header that promises 900,000 x 900,000 pixels, with a right checksum.
TEST(PngFile, ASizeThatTheFileCannotHoldIsRefusedBeforeItGetsMemory) {
  const ScratchFolder folder;
  std::string file = encode_png(Image<std::uint8_t>(2, 2));
  const std::string side("\x00\x0d\xbb\xa0", 4);
  file.replace(16, 4, side);
  file.replace(20, 4, side);
  const std::string_view chunk = std::string_view(file).substr(12, 17);
  std::uint32_t crc = 0xffffffffU;  // PNG specification, annex D
  for (const char byte : chunk) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? 0xedb88320U ^ (crc >> 1) : crc >> 1;
  }
  crc ^= 0xffffffffU;
  for (std::size_t i = 0; i < 4; ++i) file[29 + i] = static_cast<char>(crc >> (24 - 8 * i));
  ASSERT_TRUE(write_file(folder / "lie.png", file));
  const auto image = read_png8(folder / "lie.png");
  ASSERT_FALSE(image);
  EXPECT_THAT(image.error().message, HasSubstr("too short for the size that it states"));
}

TEST(PngFile, APaletteComesBackWithItsIndices) {
  Image<std::uint8_t> image(9, 4);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<std::uint8_t>(i % 3);
  }
  const Palette colors = {{0, 0, 0}, {128, 0, 0}, {0, 128, 255}};
  const std::string bytes = encode_palette_png(image, colors);
  Palette found;
  const auto read = decode_palette_png(bytes, "p.png", found);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->values, image.values);
  EXPECT_EQ(found, colors);
  EXPECT_FALSE(decode_png8(bytes, "p.png")) << "a palette is not grey";
  EXPECT_THAT(decode_palette_png(encode_png(image), "grey.png", found).error().message,
              HasSubstr("grey.png: expected a palette"));
  EXPECT_FALSE(decode_palette_png(bytes.substr(0, bytes.size() / 2), "p.png", found));
}

TEST(PngFile, LabelsInColourAreTheSamePixelsInFewerBytes) {
  Image<std::uint8_t> image(64, 64, 3);
  for (int row = 16; row < 48; ++row) {
    for (int column = 8; column < 40; ++column) image.at(row, column, 1) = 7;
  }
  const std::string labels = encode_png(image, PngContent::kLabels);
  EXPECT_LT(labels.size(), encode_png(image).size());
  EXPECT_EQ(labels.find("sRGB"), std::string::npos);
  const auto read = decode_png8(labels, "l.png");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->values, image.values);
}

}  // namespace
}  // namespace seedframe
