#include "export/document.h"

#include <gtest/gtest.h>

#include "tests/export/synthetic_dataset.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

DocumentKind two_sections() {
  return {.path = "annotations/{split}.json",
          .scope = DocumentKind::Scope::kSplit,
          .header = "{\"a\":[\n",
          .breaks = {"\n],\"b\":[\n"},
          .footer = "\n]}\n",
          .separator = ",\n"};
}

class DocumentTest : public ::testing::Test {
 protected:
  fs::path path() const { return scratch_.path() / "d.json"; }
  void write(const DocumentKind& kind, int chunks) const {
    DocumentWriter writer(path(), kind);
    for (int i = 0; i < chunks; ++i) {
      writer.add(0, std::to_string(i));
      for (int k = 0; k < i % 3; ++k) writer.add(1, std::to_string(100 * i + k));
    }
    ASSERT_TRUE(writer.finish());
  }
  ScratchFolder scratch_;
};

TEST_F(DocumentTest, SectionsFollowOneAnother) {
  write(two_sections(), 3);
  EXPECT_EQ(*read_file(path()), "{\"a\":[\n0,\n1,\n2\n],\"b\":[\n100,\n200,\n201\n]}\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch_.path()), {}), 1) << "no parts are left";
  write(two_sections(), 0);
  EXPECT_EQ(*read_file(path()), "{\"a\":[\n\n],\"b\":[\n\n]}\n");
}

TEST_F(DocumentTest, IsReadBackChunkByChunk) {
  write(two_sections(), 500);
  auto reader = DocumentReader::open(path(), two_sections());
  ASSERT_TRUE(reader);
  for (int i = 0; i < 500; ++i) {
    EXPECT_FALSE(reader->at_end());
    const std::string text = std::to_string(i);
    EXPECT_EQ(reader->next(0, text.size()), text);
    for (int k = 0; k < i % 3; ++k) {
      const std::string other = std::to_string(100 * i + k);
      EXPECT_EQ(reader->next(1, other.size()), other);
    }
  }
  EXPECT_TRUE(reader->at_end());
  EXPECT_FALSE(reader->next(0, 1));
}

// A break may fall on the border of the blocks in which it is searched.
TEST_F(DocumentTest, FindsASectionWhereverItBegins) {
  const DocumentKind kind = two_sections();
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  for (std::size_t shift = 0; shift < 2 * kind.breaks[0].size(); ++shift) {
    const std::string large(kBlock - kind.breaks[0].size() - 2 + shift, 'x');
    DocumentWriter writer(path(), kind);
    writer.add(0, large);
    writer.add(1, "second");
    ASSERT_TRUE(writer.finish());
    auto reader = DocumentReader::open(path(), kind);
    ASSERT_TRUE(reader) << shift;
    EXPECT_EQ(reader->next(1, 6), "second") << shift;
    EXPECT_EQ(reader->next(0, large.size()), large) << shift;
  }
}

TEST_F(DocumentTest, IsNoneWhenItIsCutAnywhere) {
  write(two_sections(), 20);
  const std::string whole = *read_file(path());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    ASSERT_TRUE(write_quickly(path(), whole.substr(0, length)));
    EXPECT_FALSE(DocumentReader::open(path(), two_sections())) << length;
  }
}

TEST(DocumentPath, IsKnownAgain) {
  DocumentKind kind = two_sections();
  EXPECT_TRUE(is_document_of("annotations/train.json", kind, "train"));
  EXPECT_FALSE(is_document_of("annotations/bolt_train.json", kind, "train"));
  kind.path = "{split}/{scene}/scene_gt.json";
  kind.scope = DocumentKind::Scope::kScene;
  EXPECT_EQ(kind.path_of("val", 12, 0), "val/000012/scene_gt.json");
  EXPECT_TRUE(is_document_of("val/000012/scene_gt.json", kind, "val"));
  EXPECT_TRUE(is_document_of("val/12345678/scene_gt.json", kind, "val"));
  EXPECT_FALSE(is_document_of("val/000012/scene_gt_info.json", kind, "val"));
  EXPECT_FALSE(is_document_of("val/00x012/scene_gt.json", kind, "val"));
  EXPECT_FALSE(is_document_of("val/scene_gt.json", kind, "val"));
}

}  // namespace
}  // namespace seedframe
