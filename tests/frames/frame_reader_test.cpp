#include "frames/frame_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/export/synthetic_dataset.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class FrameReaderTest : public ::testing::Test {
 protected:
  FrameReaderTest() : campaign_(scratch_.path()) {
    IdImage ids(12, 10);
    ids.at(2, 3) = ids.at(2, 4) = 3;
    ids.at(7, 7) = 4;
    campaign_.add_frame(17, 2, ids);
  }

  Result<LoadedFrame> load() const {
    const CommittedFrame& frame = campaign_.frames().at(0);
    const auto reader = FrameReader::open(frame, {.image_file = true});
    if (!reader) return forward_error(reader);
    return reader->load(campaign_.dataset().categories);
  }
  fs::path file(const char* name) const { return campaign_.frame_folder(17) / name; }

  /// Changes labels.json through its JSON.
  template <class F>
  void edit_labels(F edit) {
    Json json = *parse_json(*read_file(file(frame_files::kLabels)), "labels");
    edit(json);
    ASSERT_TRUE(write_file(file(frame_files::kLabels), readable_json(json)));
    campaign_.write_manifest(campaign_.frames().at(0));
  }

  void expect_corrupt(const std::vector<std::string>& words) const {
    const auto loaded = load();
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(loaded.error().message, HasSubstr("frame 17"));
    for (const std::string& word : words) EXPECT_THAT(loaded.error().message, HasSubstr(word));
  }

  ScratchFolder scratch_;
  SyntheticDataset campaign_;
};

TEST_F(FrameReaderTest, ReturnsTheLabelsAndTheIds) {
  const auto loaded = load();
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->instance_ids.values, campaign_.truth(17).ids.values);
  EXPECT_EQ(to_json(loaded->labels), to_json(campaign_.truth(17).labels));
}

TEST_F(FrameReaderTest, NoticesAnotherArea) {
  edit_labels([](Json& json) { json["instances"][0]["area_px"] = 1; });
  expect_corrupt({"instance 3", "'bolt/0'", "1 pixels", "instances.png has 2"});
}

TEST_F(FrameReaderTest, NoticesAnotherBox) {
  edit_labels([](Json& json) { json["instances"][0]["box"] = {3, 2, 2, 2}; });
  expect_corrupt({"instance 3", "[3, 2, 2, 2]", "[3, 2, 2, 1]"});
}

TEST_F(FrameReaderTest, NoticesAnInstanceThatTheLabelsDoNotKnow) {
  edit_labels([](Json& json) { json["instances"].erase(0); });
  expect_corrupt({"instance 3", "2 pixels"});
}

TEST_F(FrameReaderTest, NoticesAnInstanceThatTheImageDoesNotHave) {
  IdImage ids(12, 10);
  ids.at(2, 3) = ids.at(2, 4) = 3;
  ASSERT_TRUE(write_file(file(frame_files::kInstances), encode_png(ids)));
  campaign_.write_manifest(campaign_.frames().at(0));
  expect_corrupt({"instance 4", "'rock/0'", "instances.png has 0"});
}

TEST_F(FrameReaderTest, NoticesAnotherSize) {
  edit_labels([](Json& json) { json["width"] = 13; });
  expect_corrupt({"13x10", "12x10"});
}

TEST_F(FrameReaderTest, NoticesACategoryThatTheLabelsDoNotHave) {
  edit_labels([](Json& json) { json["instances"][0]["category"] = 5; });
  expect_corrupt({"instances[0]", "category 5 of 4"});
}

TEST_F(FrameReaderTest, NamesAClassThatTheConfigNoLongerHas) {
  campaign_.dataset().categories = {"bolt", "gear", "say \"über\""};
  expect_corrupt({"class 'no'", "no longer has", "submit"});
}

TEST_F(FrameReaderTest, NoticesClassesInAnotherOrder) {
  std::swap(campaign_.dataset().categories[0], campaign_.dataset().categories[1]);
  expect_corrupt({"another order"});
}

TEST_F(FrameReaderTest, NoticesAMaskThatWasChangedAfterwards) {
  IdImage ids(12, 10);
  ids.at(2, 3) = ids.at(2, 4) = 3;
  ids.at(7, 8) = 4;
  ASSERT_TRUE(write_file(file(frame_files::kInstances), encode_png(ids)));
  expect_corrupt({"instances.png has changed"});
}

TEST_F(FrameReaderTest, NoticesAnImageThatWasChangedAfterwards) {
  std::string bytes = *read_file(file("image.png"));
  bytes[bytes.size() / 2] ^= 1;
  ASSERT_TRUE(write_file(file("image.png"), bytes));
  expect_corrupt({"image.png has changed"});
}

TEST_F(FrameReaderTest, TheKeyChangesWithAnyFileAndWithTheScene) {
  const auto key = [this] { return FrameReader::open(campaign_.frames().at(0), {})->key(); };
  const std::string before = key();
  EXPECT_EQ(key(), before);
  ++campaign_.frames().at(0).scene;
  EXPECT_NE(key(), before);
  --campaign_.frames().at(0).scene;
  ASSERT_TRUE(write_file(file("image.png"), encode_png(Image<std::uint8_t>(12, 10, 3))));
  campaign_.write_manifest(campaign_.frames().at(0));
  EXPECT_NE(key(), before);
}

TEST_F(FrameReaderTest, NoticesLabelsThatAreCut) {
  const std::string text = *read_file(file(frame_files::kLabels));
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, text.size() / 2}) {
    ASSERT_TRUE(write_file(file(frame_files::kLabels), text.substr(0, length)));
    campaign_.write_manifest(campaign_.frames().at(0));
    expect_corrupt({"labels.json"});
  }
}

TEST_F(FrameReaderTest, NoticesMissingFiles) {
  const std::string labels = *read_file(file(frame_files::kLabels));
  fs::remove(file(frame_files::kLabels));
  auto loaded = load();
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("frame 17"));
  EXPECT_THAT(loaded.error().message, HasSubstr("labels.json"));
  ASSERT_TRUE(write_file(file(frame_files::kLabels), labels));
  fs::remove(file(frame_files::kInstances));
  loaded = load();
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("frame 17"));
  EXPECT_THAT(loaded.error().message, HasSubstr("instances.png"));
}

}  // namespace
}  // namespace seedframe
