// Pictures as PNG, JPEG, WebP and TIFF: a campaign with each is rendered, resumed, audited and
// exported, and PIL, which knows nothing of Seedframe, reads its files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/sha256.h"
#include "frames/frame_image.h"
#include "frames/manifest.h"
#include "tests/cli/program.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kPictures = R"(seedframe: 1
name: pictures
scenes: 2
frames_per_scene: 2
categories: [gear]
render: {width: 40, height: 30, samples: 1, passes: [depth]}
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
camera: {distance_m: {uniform: [0.2, 0.5]}}
labels: {check: false}
)";

class PicturesTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_config("");
  }
  /// `image` is what the section has beside the colour config: ", format: jpeg".
  void write_config(const std::string& image, const std::string& name = "pictures.yaml") {
    write(name, kPictures + ("image: {ocio_config: " + kOcioConfig + image + "}\n"));
  }
  Outcome blender(std::vector<std::string> arguments,
                  const std::vector<std::string>& environment = {}) {
    arguments.insert(arguments.end(), {"--blender", kFakeBlender, "--quiet"});
    return run(arguments, environment);
  }
  void submit(const std::string& campaign, const std::string& workers = "1") {
    const Outcome made = blender({"submit", "pictures.yaml", "-o", campaign, "--workers", workers});
    ASSERT_EQ(made.exit_code, 0) << made.errors;
  }
  std::vector<std::string> export_all(const std::string& campaign, bool bop) {
    std::vector<std::string> arguments = {"export", campaign, "-o", "out"};
    for (const char* format :
         {"coco", "coco-polygon", "coco-panoptic", "yolo-detect", "yolo-segment", "yolo-obb", "voc",
          "patches", "webdataset", "statistics", "bop"}) {
      if (bop || format != std::string("bop")) {
        arguments.insert(arguments.end(), {"--format", format});
      }
    }
    return arguments;
  }
  std::string dataset_hash(const std::string& campaign) {
    return status(campaign).at("dataset_hash").get<std::string>();
  }
  fs::path frame(const std::string& campaign, int index) const {
    return folder_ / campaign / "frames/000" / fmt::format("{:06}", index);
  }
};

struct Asked {
  const char* image;
  const char* file;
  const char* said;  ///< by explain
  bool bop;          ///< takes it
};

class EveryPicture : public PicturesTest, public ::testing::WithParamInterface<Asked> {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_config(GetParam().image);
  }
};

INSTANTIATE_TEST_SUITE_P(
    Formats, EveryPicture,
    ::testing::Values(Asked{", compression: 9", "image.png", "png, compression 9", true},
                      Asked{", format: jpeg, quality: 85", "image.jpg", "jpeg, quality 85", true},
                      Asked{", format: webp", "image.webp", "webp, quality 95", false},
                      Asked{", format: tiff, compression: lzw", "image.tif",
                            "tiff, compression lzw", false}),
    [](const auto& test) {
      std::string name = test.param.said;
      std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
      return name;
    });

TEST_P(EveryPicture, IsTheSameWhateverTheWorkersAndOfThePixelsOfAnyFormat) {
  submit("one");
  submit("again", "2");
  EXPECT_EQ(contents("one/frames"), contents("again/frames"));
  EXPECT_TRUE(fs::exists(frame("one", 0) / GetParam().file));
  write_config("");
  submit("png");
  EXPECT_EQ(dataset_hash("png"), dataset_hash("one"));
  EXPECT_THAT(run({"compare", "png", "one"}).output, HasSubstr("4 frames are identical"));
}

TEST_P(EveryPicture, IsReadByPilAsByUs) {
  submit("c");
  const Outcome read = python("pictures.py " + (folder_ / "c").string());
  ASSERT_EQ(read.exit_code, 0) << read.output;
  for (int i = 0; i < 4; ++i) {
    const auto manifest = read_manifest(frame("c", i));
    ASSERT_TRUE(manifest);
    const auto image = read_frame_image(frame("c", i), manifest->image.format);
    ASSERT_TRUE(image) << image.error().message;
    const std::string values(image->values.begin(), image->values.end());
    EXPECT_THAT(read.output,
                HasSubstr(fmt::format("{} {} {}", i, fs::path(GetParam().file).extension().string(),
                                      sha256_hex(values))));
  }
}

TEST_P(EveryPicture, IsExplainedResumedAndAudited) {
  submit("c");
  EXPECT_THAT(run({"explain", "c", "1"}).output,
              HasSubstr(fmt::format("picture    {} ({})", GetParam().file, GetParam().said)));
  const auto before = contents("c/frames");
  const Outcome resumed = blender({"resume", "c", "--verify"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_THAT(resumed.output, HasSubstr("0 in this run"));
  const Outcome audited = blender({"audit", "c"});
  EXPECT_EQ(audited.exit_code, 0) << audited.output << audited.errors;
  EXPECT_THAT(audited.output, HasSubstr("4 of 4 frames were audited: 4 identical"));
  EXPECT_EQ(contents("c/frames"), before);
}

TEST_P(EveryPicture, IsMadeAnewWhenItIsDamaged) {
  submit("c");
  const auto before = contents("c/frames");
  const std::string name = "c/frames/000/000002/" + std::string(GetParam().file);
  std::string bytes = *read_file(folder_ / name);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write(name, bytes);
  EXPECT_EQ(run({"export", "c", "--format", "coco"}).exit_code, 5);
  const Outcome resumed = blender({"resume", "c", "--verify"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_THAT(resumed.errors, HasSubstr(std::string(GetParam().file) + " has changed"));
  EXPECT_EQ(contents("c/frames"), before);
}

TEST_P(EveryPicture, IsInEveryExportUnderItsName) {
  submit("c");
  const Outcome exported = run(export_all("c", GetParam().bop));
  ASSERT_EQ(exported.exit_code, 0) << exported.errors;
  const Outcome found =
      python("pictures.py " + (folder_ / "c").string() + " " + (folder_ / "out").string());
  EXPECT_EQ(found.exit_code, 0) << found.output;
  const Outcome verified = run({"export", "c", "--verify", "-o", "out"});
  EXPECT_EQ(verified.exit_code, 0) << verified.errors;
  const auto before = contents("out");
  ASSERT_EQ(run(export_all("c", GetParam().bop)).exit_code, 0);
  EXPECT_EQ(contents("out"), before);
  const Outcome bop = run({"export", "c", "-o", "bop", "--format", "bop"});
  EXPECT_EQ(bop.exit_code == 0, GetParam().bop);
  if (!GetParam().bop) {
    EXPECT_EQ(bop.exit_code, 2);
    EXPECT_THAT(bop.errors, HasSubstr("BOP's tools look for images that end in .png or .jpg"));
    EXPECT_FALSE(exists("bop/bop"));
  }
}

TEST_F(PicturesTest, AreSetFromTheCommandLine) {
  const Outcome made = blender({"submit", "pictures.yaml", "-o", "c", "--set", "image.format=jpeg",
                                "--set", "image.quality=70"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_TRUE(fs::exists(frame("c", 3) / "image.jpg"));
  EXPECT_FALSE(fs::exists(frame("c", 3) / "image.png"));
  const Outcome wrong = run({"check", "pictures.yaml", "--set", "image.format=jpg"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("image.format: expected one of png, jpeg, webp, tiff"));
}

TEST_F(PicturesTest, AreMadeAnewWhenTheConfigWantsOthers) {
  submit("c");
  const auto frame_id = [&] {
    return Json::parse(run({"explain", "c", "0", "--json"}).output).at("frame_id");
  };
  const Json id = frame_id();
  const std::string hash = dataset_hash("c");
  write_config(", format: jpeg, quality: 50", "c/campaign.yaml");
  // Half of the way: what was not made anew is not taken for what is wanted.
  const Outcome half = blender({"resume", "c", "--frame", "1", "--yes"});
  EXPECT_EQ(half.exit_code, 0) << half.errors;
  EXPECT_THAT(half.errors, HasSubstr("4 frames have become different (4 of them finished)"));
  EXPECT_TRUE(fs::exists(frame("c", 1) / "image.jpg"));
  EXPECT_TRUE(fs::exists(frame("c", 2) / "image.png"));
  const Outcome whole = blender({"resume", "c"});
  EXPECT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_THAT(whole.output, HasSubstr("3 in this run"));
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(fs::exists(frame("c", i) / "image.jpg"));
    EXPECT_FALSE(fs::exists(frame("c", i) / "image.png"));
  }
  EXPECT_EQ(dataset_hash("c"), hash) << "the pixels before they are encoded are the same";
  EXPECT_EQ(frame_id(), id);
  write_config(", format: jpeg, quality: 90", "c/campaign.yaml");
  EXPECT_THAT(blender({"resume", "c", "--yes"}).output, HasSubstr("4 in this run"));
  EXPECT_THAT(blender({"resume", "c"}).output, HasSubstr("0 in this run"));
}

TEST_F(PicturesTest, LabelsAloneHaveNone) {
  const auto label = [&](const std::string& campaign, const std::string& format) {
    return run({"submit", "pictures.yaml", "-o", campaign, "--set", "labels=geometry", "--set",
                "image.format=" + format, "--quiet"});
  };
  ASSERT_EQ(label("jpeg", "jpeg").exit_code, 0);
  ASSERT_EQ(label("png", "png").exit_code, 0);
  EXPECT_EQ(contents("jpeg/frames"), contents("png/frames"));
  EXPECT_THAT(run({"resume", "jpeg", "--verify", "--quiet"}).output, HasSubstr("0 in this run"));
}

TEST_F(PicturesTest, AreTakenFromTheCacheOnlyIfTheyAreEncodedAlike) {
  const std::vector<std::string> cache = {"SEEDFRAME_CACHE=" + (folder_ / "cache").string()};
  const auto submit_with = [&](const std::string& campaign, const std::string& format) {
    const Outcome made = blender({"submit", "pictures.yaml", "-o", campaign, "--workers", "1",
                                  "--set", "image.format=" + format},
                                 cache);
    EXPECT_EQ(made.exit_code, 0) << made.errors;
    return made.output;
  };
  EXPECT_THAT(submit_with("png", "png"), Not(HasSubstr("found on this machine")));
  EXPECT_THAT(submit_with("jpeg", "jpeg"), Not(HasSubstr("found on this machine")));
  EXPECT_THAT(submit_with("again", "jpeg"), HasSubstr("4 of them found on this machine"));
  EXPECT_EQ(contents("again/frames"), contents("jpeg/frames"));
}

// The dynamic loader says which libraries it opens.
TEST_F(PicturesTest, OnlyWhoReadsOrWritesThemOpensTheLibrary) {
  const std::vector<std::string> tell = {"LD_DEBUG=files"};
  const auto opens = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = run(arguments, tell);
    EXPECT_THAT(outcome.errors, HasSubstr("libsqlite3")) << "the loader says nothing";
    return outcome.errors.find("seedframe_image_module") != std::string::npos;
  };
  submit("png");
  write_config(", format: jpeg");
  submit("jpeg");
  EXPECT_FALSE(opens({"--version"}));
  for (const std::string campaign : {"png", "jpeg"}) {
    EXPECT_FALSE(opens({"status", campaign}));
    EXPECT_FALSE(opens({"explain", campaign, "0"}));
    EXPECT_FALSE(opens({"export", campaign, "--format", "coco", "--format", "webdataset"}));
    EXPECT_TRUE(opens({"export", campaign, "--format", "patches"}));
    EXPECT_FALSE(opens({"export", campaign, "--format", "patches"})) << "nothing has changed";
    EXPECT_FALSE(opens({"compare", campaign, campaign}));
  }
}

}  // namespace
}  // namespace seedframe
