// Images of a config that are damaged, or not what is needed: found before anything renders.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A config with a material folder "images", a copy of tests/fixtures/images.
class InputImagesTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::copy(fs::path(SEEDFRAME_HOME) / "tests/fixtures/images", folder_ / "images",
             fs::copy_options::recursive);
  }

  void write_config(const std::string& more) {
    write("c.yaml",
          "seedframe: 1\nmaterial_folders: [images]\ncamera: {distance_m: 1}\n" + more + "\n");
  }

  /// Of check and of submit; nothing is rendered or written.
  void expect_refused(const std::string& more, const std::string& message) {
    write_config(more);
    const Outcome checked = run({"check", "c.yaml"});
    EXPECT_EQ(checked.exit_code, 2) << more << checked.errors;
    EXPECT_THAT(checked.errors, HasSubstr(message)) << more;
    EXPECT_THAT(checked.errors, HasSubstr("c.yaml:4:")) << more;
    const Outcome submitted = run({"submit", "c.yaml", "-o", "c", "--blender", kFakeBlender});
    EXPECT_EQ(submitted.exit_code, 2) << more << submitted.errors;
    EXPECT_THAT(submitted.errors, HasSubstr(message)) << more;
    EXPECT_FALSE(exists("c")) << more;
  }

  void expect_refused_map(const std::string& name, const std::string& message) {
    expect_refused("world: {hdri: " + name + "}", message);
  }

  void put(const std::string& file, const std::string& bytes) {
    fs::create_directories((folder_ / file).parent_path());
    write(file, bytes);
  }

  std::vector<std::string> with_cache() const {
    return {"SEEDFRAME_CACHE=" + (folder_ / "cache").string()};
  }
};

TEST_F(InputImagesTest, DamagedOnesAreNamedWithTheirReason) {
  expect_refused_map("cut_flat", "images/hdri/cut_flat.hdr is a damaged or cut Radiance file");
  expect_refused_map("no_pixels", "images/hdri/no_pixels.hdr is no Radiance file");
  expect_refused("ground: {material: jpgcut}", "images/jpgcut/x_Color.jpg is cut");
}

TEST_F(InputImagesTest, WholeOnesThatAreNotWhatIsNeededAreNamedWithTheirReason) {
  expect_refused_map("layered", "images/hdri/layered.exr has its channels in layers");
  expect_refused_map("nan_pixel", "images/hdri/nan_pixel.exr has a value that is no number (NaN)");
  expect_refused_map("luminance_only", "images/hdri/luminance_only.exr has luminance alone (Y)");
}

TEST_F(InputImagesTest, WhatIsNoImageIsNamedForWhatItIs) {
  put("images/lfs/x_Color.png", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
  put("images/page/x_Color.jpg", "<!DOCTYPE html>\n<html><body>404</body></html>\n");
  put("images/none/x_Color.tif", "");
  expect_refused("ground: {material: lfs}", "lfs/x_Color.png is no PNG: it is a Git LFS pointer");
  expect_refused("ground: {material: page}", "page/x_Color.jpg is no JPEG: it is an HTML page");
  expect_refused("ground: {material: none}", "none/x_Color.tif is no TIFF: it is empty");
  put("images/hdri/huge.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 90000 +X 90000\n");
  expect_refused_map("huge", "images/hdri/huge.hdr is too large: 90000 × 90000");
  put("images/psd/x_Color.psd", "8BPS");
  expect_refused("ground: {material: psd}", "its colour is images/psd/x_Color.psd, and images end");
}

TEST_F(InputImagesTest, AllThatTheConfigCanDrawAreNamedAtOnceAndNoOthers) {
  write_config("world: {hdri: {choice: [cut_flat, studio, layered]}}");
  const Outcome checked = run({"check", "c.yaml"});
  EXPECT_EQ(checked.exit_code, 2);
  EXPECT_THAT(checked.errors, HasSubstr("cut_flat.hdr"));
  EXPECT_THAT(checked.errors, HasSubstr("layered.exr"));
  EXPECT_EQ(checked.errors.find("nan_pixel"), std::string::npos);
  write_config("world: {hdri: studio}");
  EXPECT_EQ(run({"check", "c.yaml"}).exit_code, 0);
}

/// A copy of the program has no module beside it that could decode an image.
TEST_F(InputImagesTest, AFileThatIsKnownToBeGoodIsNotDecodedAgain) {
  write_config("world: {hdri: studio}\nground: {material: Planks01}");
  fs::create_directory(folder_ / "bin");
  fs::copy_file(SEEDFRAME_PROGRAM, folder_ / "bin/seedframe");
  const auto run_copy = [&](const std::vector<std::string>& environment) {
    std::string command = "cd " + folder_.string() + " && env SEEDFRAME_HOME=" SEEDFRAME_HOME " ";
    for (const std::string& entry : environment) command += entry + " ";
    command += "bin/seedframe check c.yaml > copy.txt 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  };
  EXPECT_EQ(run_copy(with_cache()), 4);
  EXPECT_THAT(*read_file(folder_ / "copy.txt"),
              HasSubstr("the library that reads and writes images is missing"));
  EXPECT_THAT(*read_file(folder_ / "copy.txt"), HasSubstr("install OpenImageIO"));
  EXPECT_EQ(run({"check", "c.yaml"}, with_cache()).exit_code, 0);
  EXPECT_EQ(run_copy(with_cache()), 0) << *read_file(folder_ / "copy.txt");
  EXPECT_EQ(run_copy({"SEEDFRAME_CACHE=off"}), 4);
  write_config("world: {hdri: overcast}");
  EXPECT_EQ(run_copy(with_cache()), 4);
}

TEST_F(InputImagesTest, ABrokenCacheIsNone) {
  write_config("world: {hdri: studio}");
  write("cache", "a file where a folder is expected");
  EXPECT_EQ(run({"check", "c.yaml"}, with_cache()).exit_code, 0);
}

TEST_F(InputImagesTest, AnImageThatBreaksBeforeAResumeIsFoundThere) {
  fs::copy_file(fs::path(SEEDFRAME_HOME) / "materials/hdri/studio.exr",
                folder_ / "images/hdri/own.exr");
  write_config(
      "categories: [cube]\nlabels: geometry\nscenes: 2\n"
      "objects: {o: {asset: cube}}\nworld: {hdri: own}");
  const std::vector<std::string> submit = {"submit", "c.yaml", "-o", "c", "--frames", "1"};
  const Outcome submitted = run(submit);
  ASSERT_EQ(submitted.exit_code, 0) << submitted.errors;
  fs::resize_file(folder_ / "images/hdri/own.exr", 5000);
  const Outcome resumed = run({"resume", "c"});
  EXPECT_EQ(resumed.exit_code, 2) << resumed.errors;
  EXPECT_THAT(resumed.errors, HasSubstr("own.exr is a damaged or cut OpenEXR file"));
}

}  // namespace
}  // namespace seedframe
