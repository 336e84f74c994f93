// Damaged files and streams: an error or a valid mesh, never a crash, a hang or a flood of memory.
// SEEDFRAME_FUZZ_RUNS says how many are tried (scripts/fuzz_assets.sh), SEEDFRAME_FUZZ_SEED which.

#include <cstdlib>

#include <gtest/gtest.h>

#include "base/files.h"
#include "base/philox.h"
#include "mesh/mesh_measure.h"
#include "mesh/mesh_repair.h"
#include "mesh/mesh_self_intersections.h"
#include "mesh_files/draco_codec.h"
#include "mesh_files/mesh_file.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/mesh/example_meshes.h"
#include "tests/mesh_files/example_files.h"

namespace seedframe {
namespace {

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

// Random numbers of one damage, a pure function of the seed, the name and the number of the run.
class Dice {
 public:
  Dice(const PhiloxStream& stream, std::uint32_t run) : stream_(stream), run_(run) {}
  std::uint64_t below(std::uint64_t limit) {
    return (stream_.bits({.frame = run_, .copy = draw_++}) >> 11) % limit;
  }

 private:
  const PhiloxStream& stream_;
  std::uint32_t run_;
  std::uint32_t draw_ = 0;
};

std::string damaged(std::string bytes, Dice& dice) {
  const std::uint64_t kind = dice.below(8);
  if (kind == 0) return bytes.substr(0, dice.below(bytes.size()));
  if (kind == 1) {  // a piece twice, or missing
    const std::size_t start = dice.below(bytes.size());
    const std::string piece = bytes.substr(start, 1 + dice.below(64));
    if (dice.below(2) == 0) return bytes.insert(dice.below(bytes.size()), piece);
    return bytes.erase(start, piece.size());
  }
  for (std::uint64_t change = 1 + dice.below(6); change > 0; --change) {
    char& byte = bytes[dice.below(bytes.size())];
    switch (dice.below(4)) {
      case 0:
        byte = static_cast<char>(byte ^ (1 << dice.below(8)));
        break;
      case 1:
        byte = "\0\x7f\xff\x80"[dice.below(4)];
        break;
      case 2:
        byte = "0123456789-+.eE/[]{}\",:# \n"[dice.below(26)];
        break;
      default:
        byte = static_cast<char>(dice.below(256));
    }
  }
  return bytes;
}

// What an import does next must stand a strange mesh, too.
void expect_valid(const Mesh& mesh) {
  ASSERT_TRUE(check_mesh(mesh, "damaged"));
  const auto repaired = repair_mesh(mesh, {.fill_holes = 8}, "damaged");
  if (!repaired) return;
  ASSERT_TRUE(check_mesh(repaired->mesh, "repaired"));
  const MeshMeasures measures = measure_mesh(repaired->mesh);
  EXPECT_EQ(measures.bad_edges, 0u);
  ASSERT_TRUE(count_self_intersections(repaired->mesh, "repaired"));
}

TEST(InputFuzz, DamagedDracoStreamsAreErrorsOrValidMeshes) {
  const std::uint64_t runs = number_from("SEEDFRAME_FUZZ_RUNS", 2000);
  const PhiloxStream stream(number_from("SEEDFRAME_FUZZ_SEED", 1), "fuzz-draco");
  std::vector<std::string> originals;
  for (const Mesh& mesh : {example_cube(), example_patch(8), example_patch(30)}) {
    originals.push_back(*encode_draco(mesh));
  }
  for (std::uint32_t run = 0; run < runs && !::testing::Test::HasFatalFailure(); ++run) {
    Dice dice(stream, run);
    const std::string bytes = damaged(originals[run % originals.size()], dice);
    // A copy of its own length lets a sanitizer see a read behind the end.
    const std::vector<char> exact(bytes.begin(), bytes.end());
    const auto mesh = decode_draco({exact.data(), exact.size()}, "damaged.drc");
    if (!mesh) {
      EXPECT_EQ(mesh.error().kind, ErrorKind::kCorrupt) << "run " << run;
      continue;
    }
    ASSERT_TRUE(check_mesh(*mesh, "damaged.drc")) << "run " << run;
  }
}

TEST(InputFuzz, DamagedMeshFilesAreErrorsOrValidMeshes) {
  const std::uint64_t runs = number_from("SEEDFRAME_FUZZ_RUNS", 2000);
  const PhiloxStream stream(number_from("SEEDFRAME_FUZZ_SEED", 1), "fuzz-files");
  std::vector<ExampleFile> files = example_files(example_cube());
  for (ExampleFile& file : example_files(example_patch(4))) files.push_back(std::move(file));
  const ScratchFolder folder;
  for (std::uint32_t run = 0; run < runs && !::testing::Test::HasFatalFailure(); ++run) {
    Dice dice(stream, run);
    const ExampleFile& file = files[run % files.size()];
    ASSERT_TRUE(write_file_unsynced(folder / file.name, damaged(file.bytes, dice)));
    const auto mesh = read_mesh_file(folder / file.name);
    if (!mesh) {
      EXPECT_EQ(mesh.error().kind, ErrorKind::kInput) << file.name << ", run " << run;
      continue;
    }
    SCOPED_TRACE(fmt::format("{}, run {}", file.name, run));
    expect_valid(mesh->mesh);
  }
}

}  // namespace
}  // namespace seedframe
