#include "formats/tar_member.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(TarMember, IsPinned) {
  const auto member = tar_member("000042.json", "{}\n");
  ASSERT_TRUE(member) << member.error().message;
  ASSERT_EQ(member->size(), 1024U);
  const auto field = [&](std::size_t begin, std::size_t length) {
    return std::string(member->substr(begin, length).c_str());
  };
  EXPECT_EQ(field(0, 100), "000042.json");
  EXPECT_EQ(field(100, 8), "000644 ");
  EXPECT_EQ(field(108, 8), "000000 ");
  EXPECT_EQ(field(116, 8), "000000 ");
  EXPECT_EQ(field(124, 12), "00000000003 ");
  EXPECT_EQ(field(136, 12), "00000000000 ");
  EXPECT_EQ(member->substr(156, 1), "0");
  EXPECT_EQ(member->substr(257, 8), std::string("ustar\0"
                                                "00",
                                                8));
  EXPECT_EQ(member->substr(512), "{}\n" + std::string(509, '\0'));
}

TEST(TarMember, ReadsBackWhatWasWritten) {
  std::string members;
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{511}, std::size_t{512}, std::size_t{5000}}) {
    members += *tar_member(std::to_string(size), std::string(size, 'x'));
  }
  EXPECT_EQ(members.size() % 512, 0U);
  const auto read = read_tar_members(members);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 4U);
  EXPECT_EQ((*read)[3].first, "5000");
  EXPECT_EQ((*read)[3].second, std::string(5000, 'x'));
}

TEST(TarMember, DamageIsNoArchive) {
  std::string members = *tar_member("a", "content");
  members[0] ^= 1;  // the header's sum is another
  EXPECT_FALSE(read_tar_members(members));
  EXPECT_FALSE(read_tar_members(tar_member("a", std::string(5000, 'x'))->substr(0, 1024)));
}

TEST(TarMember, ANameThatIsTooLongIsAnError) {
  EXPECT_FALSE(tar_member(std::string(300, 'n'), "content"));
}

}  // namespace
}  // namespace seedframe
