// The section `determinism`, and the settings that it does not go with.

#include "config/determinism_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/message_of.h"

namespace seedframe {
namespace {

using Mode = Determinism::Mode;
using ::testing::HasSubstr;

Result<CampaignConfig> read_with(const std::string& more) {
  return read_campaign_config("seedframe: 1\ncamera: {distance_m: 1}\n" + more, "d.yaml");
}

std::string refusal_of(const std::string& more) {
  const auto config = read_with(more);
  return message_of(config);
}

TEST(DeterminismSection, IsOfTheMachineUnlessSaidOtherwise) {
  EXPECT_EQ(read_with("")->determinism.mode, Mode::kMachine);
  EXPECT_EQ(read_with("determinism: none\n")->determinism.mode, Mode::kNone);
  EXPECT_EQ(read_with("determinism: portable\n")->determinism.isa, Isa::kAvx2);
  const auto config = read_with("determinism: {mode: portable, isa: sse41}\n");
  EXPECT_EQ(config->determinism.mode, Mode::kPortable);
  EXPECT_EQ(config->determinism.isa, Isa::kSse41);
}

TEST(DeterminismSection, ErrorsNameTheKey) {
  EXPECT_THAT(refusal_of("determinism: portabel\n"),
              HasSubstr("d.yaml:3:14: determinism: expected 'machine', 'portable' or 'none', found "
                        "'portabel' (did you mean 'portable'?)"));
  EXPECT_THAT(
      refusal_of("determinism: {mode: portable, isa: avx512}\n"),
      HasSubstr("determinism.isa: expected one of sse2, sse41, sse42, avx, avx2, found 'avx512'"));
  EXPECT_THAT(refusal_of("determinism: {isa: avx}\n"),
              HasSubstr("only 'mode: portable' pins the instruction set"));
}

TEST(DeterminismSection, PersistentDataNeedsTheModeNone) {
  EXPECT_THAT(
      refusal_of("render: {persistent_data: true}\n"),
      HasSubstr("d.yaml:3:27: render.persistent_data: persistent_data makes the pixels of a "
                "frame depend on the frames that its worker rendered before"));
  EXPECT_THAT(refusal_of("determinism: portable\nrender: {persistent_data: true}\n"),
              HasSubstr("give the promise up with 'determinism: none'"));
  EXPECT_TRUE(
      read_with("determinism: none\nrender: {persistent_data: true}\n")->render.persistent_data);
}

}  // namespace
}  // namespace seedframe
