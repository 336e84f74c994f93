// Every input that a fuzz target starts from, and every one that once broke a promise: as it is,
// cut anywhere, and with holes of zeros. scripts/fuzz.sh looks for more.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fuzz/targets.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

struct Target {
  const char* name;
  void (*run)(std::string_view bytes);
};

class FuzzCorpus : public ::testing::TestWithParam<Target> {
 protected:
  void run(const std::string& bytes) const {
    // A copy of its own length lets a sanitizer see a read behind the end.
    const std::vector<char> exact(bytes.begin(), bytes.end());
    GetParam().run({exact.data(), exact.size()});
  }

  /// Names and bytes, sorted. Inputs longer than a seed are about their length: cutting them
  /// anywhere would only take time.
  static std::vector<std::pair<std::string, std::string>> inputs(std::size_t longest) {
    std::vector<std::pair<std::string, std::string>> inputs;
    const fs::path folder = fs::path(SEEDFRAME_HOME) / "tests/fuzz/corpus" / GetParam().name;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const auto bytes = read_file(entry.path());
      EXPECT_TRUE(bytes);
      if (bytes->size() <= longest) inputs.emplace_back(entry.path().filename(), *bytes);
    }
    std::sort(inputs.begin(), inputs.end());
    return inputs;
  }
  static constexpr std::size_t kLongestSeed = 4096;
};

TEST_P(FuzzCorpus, KeepsItsPromises) {
  const auto all = inputs(SIZE_MAX);
  EXPECT_GE(all.size(), 2u);
  for (const auto& [name, bytes] : all) {
    SCOPED_TRACE(name);
    run(bytes);
  }
}

TEST_P(FuzzCorpus, KeepsThemWhenCutAnywhere) {
  for (const auto& [name, bytes] : inputs(kLongestSeed)) {
    SCOPED_TRACE(name);
    for (std::size_t length = 0; length < bytes.size(); ++length) run(bytes.substr(0, length));
  }
}

TEST_P(FuzzCorpus, KeepsThemWithZeroedBlocks) {
  for (const auto& [name, bytes] : inputs(kLongestSeed)) {
    SCOPED_TRACE(name);
    for (const std::size_t block : {1, 4, 16, 64}) {
      for (std::size_t at = 0; at + block <= bytes.size(); at += block) {
        run(std::string(bytes).replace(at, block, block, '\0'));
      }
    }
  }
}

constexpr Target kTargets[] = {
    {"config", fuzz_config},       {"frame_spec", fuzz_frame_spec},
    {"protocol", fuzz_protocol},   {"job_manifest", fuzz_job_manifest},
    {"exr_front", fuzz_exr_front}, {"draco_front", fuzz_draco_front},
    {"materials", fuzz_materials},
};
INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, ::testing::ValuesIn(kTargets),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace seedframe
