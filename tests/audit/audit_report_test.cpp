#include "audit/audit_report.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

class AuditFolder : public ::testing::Test {
 protected:
  ScratchFolder scratch_;
  fs::path folder_ = scratch_ / "audit";
};

TEST_F(AuditFolder, IsMade) {
  ASSERT_TRUE(take_audit_folder(folder_));
  EXPECT_TRUE(fs::exists(folder_ / "report.json")) << "by which it is known again";
}

TEST_F(AuditFolder, OfAnOlderAuditIsEmptied) {
  ASSERT_TRUE(take_audit_folder(folder_));
  ASSERT_TRUE(write_file(folder_ / "old", "old"));
  ASSERT_TRUE(take_audit_folder(folder_));
  EXPECT_FALSE(fs::exists(folder_ / "old"));
}

TEST_F(AuditFolder, OfAnybodyElseIsLeftAlone) {
  ASSERT_TRUE(make_folders(folder_));
  EXPECT_TRUE(take_audit_folder(folder_)) << "it was empty";
  fs::remove(folder_ / "report.json");
  ASSERT_TRUE(write_file(folder_ / "thesis", "years of work"));
  const Status taken = take_audit_folder(folder_);
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().kind, ErrorKind::kInput);
  EXPECT_TRUE(fs::exists(folder_ / "thesis"));
}

TEST_F(AuditFolder, GetsTheReportTwice) {
  ASSERT_TRUE(take_audit_folder(folder_));
  ASSERT_TRUE(write_audit_report(folder_, "parts", Audit(), {}));
  EXPECT_TRUE(fs::exists(folder_ / "report.md"));
  const Result<std::string> json = read_file(folder_ / "report.json");
  ASSERT_TRUE(json);
  EXPECT_EQ(*json, readable_json(to_json(Audit(), {})));
}

}  // namespace
}  // namespace seedframe
