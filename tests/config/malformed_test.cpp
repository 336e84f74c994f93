// Whatever stands in a config: it is read or refused with a message for its author.

#include <gtest/gtest.h>

#include "config/campaign_config.h"
#include "tests/config/config_mutations.h"

namespace seedframe {
namespace {

/// True if it was read.
bool try_config(const NamedText& config) {
  try {
    const auto read = read_campaign_config(config.text, config.file);
    if (!read) expect_readable(read.error().message, config.text);
    return read.has_value();
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what() << "\n" << config.text;
    return false;
  }
}

void try_mutations(const NamedText& config, std::uint32_t seed, int count) {
  ASSERT_TRUE(try_config(config)) << config.file;
  ConfigMutations mutations(seed);
  int accepted = 0;
  for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
    accepted += try_config({config.file, mutations.mutated(config.text)}) ? 1 : 0;
  }
  if (count < 100) return;
  // Both happen, or the mutations are too harsh or too harmless to say anything.
  EXPECT_GT(accepted, count / 100) << config.file;
  EXPECT_LT(accepted, count * 4 / 5) << config.file;
}

TEST(MalformedConfig, EverythingMutated) { try_mutations({"all.yaml", kEverything}, 1, 4000); }

TEST(MalformedConfig, EveryExampleMutated) {
  std::uint32_t seed = 100;
  for (const NamedText& config : example_configs()) {
    ++seed;
    const bool stands_on_another = config.text.find("\nbase:") != std::string::npos;
    try_mutations(config, seed, stands_on_another ? 20 : 300);
  }
}

TEST(MalformedConfig, CutAnywhere) {
  const std::string whole = kEverything;
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    try_config({"cut.yaml", whole.substr(0, length)});
  }
}

TEST(MalformedConfig, RandomBytes) {
  std::mt19937 engine(5);
  for (int i = 0; i < 500; ++i) {
    std::string text(engine() % 300, '\0');
    for (char& c : text) c = static_cast<char>(engine() % (i % 2 == 0 ? 256 : 128));
    EXPECT_FALSE(try_config({"bytes.yaml", text}));
  }
}

}  // namespace
}  // namespace seedframe
