#include "plot/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "plot/chart_file.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Ticks, AreRoundNumbersThatEncloseTheValues) {
  const Ticks ticks = ticks_for({0.3, 9.1}, false);
  EXPECT_THAT(ticks.text, ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_EQ(ticks.from, 0.0);
  EXPECT_EQ(ticks.to, 10.0);
}

TEST(Ticks, OfEqualValuesHaveAnExtent) {
  const Ticks ticks = ticks_for({4.0, 4.0}, false);
  EXPECT_LT(ticks.from, 4.0);
  EXPECT_GT(ticks.to, 4.0);
  const Ticks logarithmic = ticks_for({1.0}, true);
  EXPECT_LT(logarithmic.from, logarithmic.to);
}

TEST(Ticks, OfNothingAreOfSomethingAllTheSame) {
  EXPECT_FALSE(ticks_for({}, false).at.empty());
  EXPECT_FALSE(ticks_for({}, true).at.empty());
  EXPECT_FALSE(ticks_for({0.0, -1.0}, true).at.empty());
  EXPECT_FALSE(ticks_for({INFINITY, NAN}, false).at.empty());
}

TEST(Ticks, OfFewDecadesTellOneTwoAndFive) {
  const Ticks ticks = ticks_for({0.3, 12.0}, true);
  EXPECT_THAT(ticks.from, DoubleNear(0.3, 1e-12));
  EXPECT_THAT(ticks.to, DoubleNear(20.0, 1e-9));
  std::vector<std::string> told;
  for (const std::string& text : ticks.text) {
    if (!text.empty()) told.push_back(text);
  }
  EXPECT_THAT(told, ElementsAre("0.5", "1", "2", "5", "10", "20"));
}

TEST(Ticks, OfManyDecadesTellPowersOfTen) {
  const Ticks ticks = ticks_for({1e-6, 50.0}, true);
  std::vector<std::string> told;
  for (const std::string& text : ticks.text) {
    if (!text.empty()) told.push_back(text);
  }
  EXPECT_THAT(told, ElementsAre("1e-06", "1e-05", "0.0001", "0.001", "0.01", "0.1", "1", "10"));
}

TEST(TickText, IsShort) {
  EXPECT_EQ(tick_text(0.0), "0");
  EXPECT_EQ(tick_text(0.002), "0.002");
  EXPECT_EQ(tick_text(20000), "20000");
  EXPECT_EQ(tick_text(0.1 + 0.2), "0.3");
  EXPECT_EQ(tick_text(-1.5), "-1.5");
  EXPECT_EQ(tick_text(1e6), "1e+06");
}

Chart some_chart() {
  Chart chart;
  chart.title = "error over time";
  chart.x = {"seconds", true};
  chart.y = {"error", true};
  Series series{"samples", {{1, 8}, {2, 6}, {4, 0}, {8, 3}}, chart_color(0)};
  series.line = true;
  series.labels = {"1", "2", "4", "8"};
  chart.series = {series};
  return chart;
}

TEST(ChartFile, IsWhatItsEndingSays) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_chart(some_chart(), folder / "a.svg"));
  ASSERT_TRUE(write_chart(some_chart(), folder / "a.png"));
  EXPECT_TRUE(read_file(folder / "a.svg").value().find("<svg") != std::string::npos);
  EXPECT_TRUE(read_file(folder / "a.png").value().starts_with("\x89PNG"));
}

TEST(ChartFile, ChangesWithThePointsAlone) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_chart(some_chart(), folder / "a.png"));
  ASSERT_TRUE(write_chart(some_chart(), folder / "again.png"));
  EXPECT_TRUE(read_file(folder / "a.png").value() == read_file(folder / "again.png").value());
  Chart other = some_chart();
  other.series[0].points[1][1] = 5;
  ASSERT_TRUE(write_chart(other, folder / "b.png"));
  EXPECT_FALSE(read_file(folder / "a.png").value() == read_file(folder / "b.png").value());
}

/// A big-endian number in a PNG's header.
unsigned png_number(const std::string& bytes, std::size_t at) {
  unsigned number = 0;
  for (std::size_t i = at; i < at + 4; ++i) {
    number = 256 * number + static_cast<unsigned char>(bytes.at(i));
  }
  return number;
}

TEST(ChartFile, ManyChartsStandInRows) {
  const ScratchFolder folder;
  Chart inside = some_chart();
  inside.legend_inside = true;
  ASSERT_TRUE(write_charts({some_chart(), inside, some_chart()}, 2, folder / "a.png", {300, 200}));
  const std::string all = read_file(folder / "a.png").value();
  EXPECT_EQ(png_number(all, 16), 2 * 2 * 300U) << "two pixels for each of the chart's";
  EXPECT_EQ(png_number(all, 20), 2 * 2 * 200U);
  ASSERT_TRUE(
      write_charts({some_chart(), some_chart(), some_chart()}, 2, folder / "b.png", {300, 200}));
  EXPECT_FALSE(read_file(folder / "b.png").value() == all) << "the legend is elsewhere";
}

TEST(ChartFile, ThatCannotBeWrittenIsAnError) {
  const ScratchFolder folder;
  for (const char* name : {"missing/a.svg", "missing/a.png"}) {
    const Status written = write_chart(some_chart(), folder / name);
    ASSERT_FALSE(written) << name;
    EXPECT_EQ(written.error().kind, ErrorKind::kEnvironment);
    EXPECT_THAT(written.error().message, HasSubstr(name));
  }
}

}  // namespace
}  // namespace seedframe
