#include "config/csv_column.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CsvColumn : public ::testing::Test {
 protected:
  Result<std::vector<double>> read(const std::string& text, const std::string& column = "size") {
    EXPECT_TRUE(write_file(file(), text));
    return read_csv_column(file(), column);
  }
  std::vector<double> values(const std::string& text, const std::string& column = "size") {
    const auto result = read(text, column);
    EXPECT_TRUE(result) << result.error().message;
    return result.value_or(std::vector<double>());
  }
  std::string error(const std::string& text, const std::string& column = "size") {
    const auto result = read(text, column);
    if (result) return "(no error)";
    EXPECT_EQ(result.error().kind, ErrorKind::kInput);
    EXPECT_THAT(result.error().message, HasSubstr(file().string()));
    return result.error().message;
  }
  std::filesystem::path file() const { return folder_ / "t.csv"; }

 private:
  ScratchFolder folder_;
};

TEST_F(CsvColumn, IsSorted) {
  EXPECT_THAT(values("name,size\na,3\nb,-1.5\nc,2e1\n"), ElementsAre(-1.5, 3.0, 20.0));
}

TEST_F(CsvColumn, IsFoundByItsName) {
  const std::string text = "a,b,c\n1,2,3\n4,5,6\n";
  EXPECT_THAT(values(text, "a"), ElementsAre(1, 4));
  EXPECT_THAT(values(text, "b"), ElementsAre(2, 5));
  EXPECT_THAT(values(text, "c"), ElementsAre(3, 6));
}

TEST_F(CsvColumn, OfTwoColumnsOfOneNameTheFirstCounts) {
  EXPECT_THAT(values("size,size\n1,2\n"), ElementsAre(1));
}

TEST_F(CsvColumn, FieldsMayBeQuoted) {
  EXPECT_THAT(values("\"name\",\"size\"\n\"a, \"\"b\"\"\nc\",\"7\"\nd,8\n"), ElementsAre(7, 8));
  EXPECT_THAT(values("\"a,b\",size\n1,2\n", "a,b"), ElementsAre(1));
  EXPECT_THAT(values("\"a\"\"b\"\n1\n", "a\"b"), ElementsAre(1));
}

TEST_F(CsvColumn, EndsOfLinesMayBeWindows) {
  EXPECT_THAT(values("name,size\r\na,3\r\nb,4\r\n"), ElementsAre(3, 4));
}

TEST_F(CsvColumn, TheLastLineNeedsNoEnd) { EXPECT_THAT(values("size\n3\n4"), ElementsAre(3, 4)); }

TEST_F(CsvColumn, AByteOrderMarkIsSkipped) {
  EXPECT_THAT(values("\xEF\xBB\xBFsize,x\n3,1\n"), ElementsAre(3));
}

TEST_F(CsvColumn, BlanksAroundAFieldAndEmptyLinesDoNotMatter) {
  EXPECT_THAT(values(" name , size \n\n a , 3 \n  \nb,\t4\n\n"), ElementsAre(3, 4));
}

TEST_F(CsvColumn, APlusSignIsANumber) {
  EXPECT_THAT(values("size\n+3\n-4\n+1.5e+1\n"), ElementsAre(-4, 3, 15));
  EXPECT_THAT(error("size\n+-3\n"), HasSubstr("needs a finite number, found '+-3'"));
}

TEST_F(CsvColumn, ANumberTooSmallToTellFromZeroIsZero) {
  EXPECT_THAT(values("size\n1e-400\n"), ElementsAre(0));
}

TEST_F(CsvColumn, OtherColumnsMayHoldAnything) {
  EXPECT_THAT(values("name,size,note\nNaN,3,\n,4,\"x\ny\"\n"), ElementsAre(3, 4));
}

TEST_F(CsvColumn, WhatIsNoFiniteNumberIsNamedByItsLine) {
  struct Case {
    const char* text;
    const char* expected;
  };
  const std::vector<Case> cases = {
      {"name,size\na,3\nb,x\n", ":3: column 'size' needs a finite number, found 'x'"},
      {"name,size\na,NaN\n", ":2: column 'size' needs a finite number, found 'NaN'"},
      {"name,size\na,inf\n", "found 'inf'"},
      {"name,size\na,1e999\n", "found '1e999'"},
      {"name,size\na,\n", ":2: column 'size' needs a finite number, found ''"},
      {"name,size\na\n", ":2: column 'size' needs a finite number, found ''"},
      {"name,size\na,3\n\nb\n", ":4: "},
      {"name,size\na,3 4\n", "found '3 4'"},
      {"name;size\na;3,5\n", "has no column 'size'"},
      {"name,size\na,0x10\n", "found '0x10'"},
      {"size\n\"3\n4\n", "found '3\n4\n'"},
      {"name,size\n\"a\nb\",1\nc,x\n", ":4: "},
  };
  for (const Case& c : cases) EXPECT_THAT(error(c.text), HasSubstr(c.expected)) << c.text;
}

TEST_F(CsvColumn, AMissingColumnGetsASuggestion) {
  EXPECT_THAT(error("name,size\na,3\n", "sise"),
              HasSubstr("has no column 'sise' (did you mean 'size'?)"));
  EXPECT_THAT(error("name,size\na,3\n", "Size"), HasSubstr("has no column 'Size'"));
}

TEST_F(CsvColumn, AFileWithoutNumbersIsAnError) {
  EXPECT_THAT(error(""), HasSubstr("has no column 'size'"));
  EXPECT_THAT(error("\n"), HasSubstr("has no column 'size'"));
  EXPECT_THAT(error("size"), HasSubstr("has no rows"));
  EXPECT_THAT(error("size\n\n\n"), HasSubstr("has no rows"));
}

TEST_F(CsvColumn, ALongCellIsNotRepeatedInFull) {
  EXPECT_LT(error("size\n" + std::string(1'000'000, 'x') + "\n").size(), 500u);
}

TEST_F(CsvColumn, BinaryFilesAreRefused) {
  std::string bytes;
  for (int i = 0; i < 4096; ++i) bytes += static_cast<char>(i * 37 % 256);
  EXPECT_NE(error(bytes), "(no error)");
  EXPECT_NE(error("size\n" + bytes), "(no error)");
}

TEST(CsvFile, MustBeThere) {
  const ScratchFolder folder;
  EXPECT_THAT(read_csv_column(folder / "t.csv", "a").error().message,
              HasSubstr("there is no file " + (folder / "t.csv").string()));
  EXPECT_THAT(read_csv_column(folder.path(), "a").error().message, HasSubstr("there is no file"));
}

}  // namespace
}  // namespace seedframe
