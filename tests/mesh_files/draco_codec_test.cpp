#include "mesh_files/draco_codec.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/philox.h"
#include "mesh/mesh_buffer.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

/// Every side of its squares is the same number of quantisation steps.
Mesh flat_grid(std::uint32_t squares) {
  Mesh mesh;
  mesh.slot_names = {"slot0"};
  const std::uint32_t side = squares + 1;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    mesh.positions.push_back({static_cast<float>(i % side), static_cast<float>(i / side), 0.0F});
  }
  for (std::uint32_t i = 0; i + side < side * side; ++i) {
    if (i % side == squares) continue;
    mesh.triangles.push_back({i, i + 1, i + side});
    mesh.triangles.push_back({i + 1, i + side + 1, i + side});
  }
  mesh.corner_uvs.resize(3 * mesh.triangles.size());
  mesh.triangle_slots.resize(mesh.triangles.size());
  return mesh;
}

struct Tolerance {
  double position = 0.0;
  double uv = 0.0;
};

// Quantising a range to b bits errs by half a step at most; the rest is float rounding.
double half_step(double range, int bits) { return 0.5 * range / ((1 << bits) - 1) + 1e-6 * range; }

Tolerance tolerance_of(const Mesh& mesh, const DracoOptions& options) {
  double uv_range = 0.0;
  for (const std::size_t axis : {0u, 1u}) {
    const auto [low, high] =
        std::minmax_element(mesh.corner_uvs.begin(), mesh.corner_uvs.end(),
                            [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    uv_range = std::max(uv_range, static_cast<double>((*high)[axis]) - (*low)[axis]);
  }
  return {.position = half_step(bounding_box(mesh).size().maxCoeff(), options.position_bits),
          .uv = half_step(uv_range, options.uv_bits)};
}

template <std::size_t N>
bool near(const std::array<float, N>& a, const std::array<float, N>& b, double tolerance) {
  for (std::size_t i = 0; i < N; ++i) {
    if (std::abs(static_cast<double>(a[i]) - b[i]) > tolerance) return false;
  }
  return true;
}

// Whether triangle s of `a` is triangle t of `b`: corners, UVs, winding and slot.
bool same_triangle(const Mesh& a, std::size_t s, const Mesh& b, std::size_t t,
                   const Tolerance& tolerance) {
  if (a.triangle_slots[s] != b.triangle_slots[t]) return false;
  for (std::size_t turn = 0; turn < 3; ++turn) {
    bool same = true;
    for (std::size_t corner = 0; corner < 3 && same; ++corner) {
      const std::size_t other = (corner + turn) % 3;
      same = near(a.positions[a.triangles[s][corner]], b.positions[b.triangles[t][other]],
                  tolerance.position) &&
             near(a.corner_uvs[3 * s + corner], b.corner_uvs[3 * t + other], tolerance.uv);
    }
    if (same) return true;
  }
  return false;
}

void expect_same_mesh(const Mesh& original, const Mesh& decoded, const Tolerance& tolerance) {
  ASSERT_EQ(decoded.triangles.size(), original.triangles.size());
  std::vector<bool> taken(original.triangles.size(), false);
  for (std::size_t t = 0; t < decoded.triangles.size(); ++t) {
    std::size_t match = 0;
    while (match < taken.size() &&
           (taken[match] || !same_triangle(original, match, decoded, t, tolerance))) {
      ++match;
    }
    ASSERT_LT(match, taken.size()) << "triangle " << t << " has no counterpart";
    taken[match] = true;
  }
}

TEST(DracoCodec, KeepsTrianglesUvsSlotsAndSharedVertices) {
  const Mesh cube = example_cube();
  const auto stream = encode_draco(cube);
  ASSERT_TRUE(stream) << stream.error().message;
  const auto decoded = decode_draco(*stream, "cube.drc");
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->positions.size(), 8u) << "UV seams and slots must not split vertices";
  EXPECT_EQ(decoded->slot_names.size(), 2u);
  EXPECT_GT(signed_volume_6(*decoded), 0.0);
  expect_same_mesh(cube, *decoded, tolerance_of(cube, {}));
}

TEST(DracoCodec, ErrsByHalfAQuantisationStepAtMost) {
  const Mesh patch = example_patch(20);
  for (const DracoOptions options :
       {DracoOptions{}, DracoOptions{.position_bits = 11, .uv_bits = 10}}) {
    const auto stream = encode_draco(patch, options);
    ASSERT_TRUE(stream) << stream.error().message;
    const auto decoded = decode_draco(*stream, "patch.drc");
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->positions.size(), patch.positions.size());
    expect_same_mesh(patch, *decoded, tolerance_of(patch, options));
  }
}

TEST(DracoCodec, IsDeterministic) {
  const auto stream = encode_draco(example_patch(12));
  ASSERT_TRUE(stream);
  EXPECT_EQ(*stream, *encode_draco(example_patch(12)));
  EXPECT_EQ(mesh_buffer(*decode_draco(*stream, "a")), mesh_buffer(*decode_draco(*stream, "b")));
  EXPECT_LT(stream->size(), mesh_buffer(example_patch(12)).size() / 5);
}

TEST(DracoCodec, TakesMeshesThatAreNotManifold) {
  Mesh mesh = example_cube();
  mesh.positions.push_back({3.0f, 0.0f, 0.0f});
  mesh.triangles.push_back({5, 1, 8});  // a third triangle on an edge
  mesh.corner_uvs.insert(mesh.corner_uvs.end(), 3, {0.25f, 0.5f});
  mesh.triangle_slots.push_back(1);
  const auto stream = encode_draco(mesh);
  ASSERT_TRUE(stream) << stream.error().message;
  const auto decoded = decode_draco(*stream, "fin.drc");
  ASSERT_TRUE(decoded) << decoded.error().message;
  expect_same_mesh(mesh, *decoded, tolerance_of(mesh, {}));
}

TEST(DracoCodec, KeepsTheNumbersOfSlotsAroundThoseWithoutTriangles) {
  Mesh mesh = example_cube();
  mesh.slot_names = {"none", "sides", "none either", "caps", "nor here"};
  for (const std::uint32_t caps : {1u, 3u}) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      mesh.triangle_slots[t] = t < 8 ? 1 : caps;
    }
    const auto stream = encode_draco(mesh);
    ASSERT_TRUE(stream) << stream.error().message;
    const auto decoded = decode_draco(*stream, "mesh");
    ASSERT_TRUE(decoded) << decoded.error().message;
    std::vector<std::uint32_t> slots = decoded->triangle_slots;
    std::sort(slots.begin(), slots.end());
    EXPECT_EQ(slots, (std::vector<std::uint32_t>{1, 1, 1, 1, 1, 1, 1, 1, caps, caps, caps, caps}));
  }
}

TEST(DracoCodec, RefusesAMeshThatIsWrong) {
  Mesh mesh = example_cube();
  mesh.triangles[0][0] = 99;
  EXPECT_FALSE(encode_draco(mesh));
}

TEST(DracoCodec, RefusesEveryTruncation) {
  const auto stream = encode_draco(example_cube());
  ASSERT_TRUE(stream);
  for (std::size_t length = 0; length < stream->size(); ++length) {
    // A copy of its own length lets a sanitizer see a read behind the end.
    const std::vector<char> cut(stream->begin(),
                                stream->begin() + static_cast<std::ptrdiff_t>(length));
    const auto decoded = decode_draco({cut.data(), cut.size()}, "cut.drc");
    ASSERT_FALSE(decoded) << length << " of " << stream->size() << " bytes";
    EXPECT_EQ(decoded.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(decoded.error().message, HasSubstr("cut.drc"));
  }
}

// A flipped bit may leave a stream that still means some mesh; it must never mean an invalid one.
void expect_valid_or_error(const std::string& bytes) {
  const auto decoded = decode_draco(bytes, "flipped.drc");
  if (!decoded) return;
  EXPECT_TRUE(check_mesh(*decoded, "flipped.drc"));
}

TEST(DracoCodec, SurvivesFlippedBits) {
  const PhiloxStream random(1, "flipped-bits");
  std::uint32_t trial = 0;
  for (const Mesh& mesh : {example_cube(), example_patch(6)}) {
    const auto stream = encode_draco(mesh);
    ASSERT_TRUE(stream);
    for (std::size_t bit = 0; bit < 8 * stream->size(); ++bit) {
      std::string bytes = *stream;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
      expect_valid_or_error(bytes);
    }
    for (int i = 0; i < 2000; ++i, ++trial) {
      std::string bytes = *stream;
      for (std::uint32_t flip = 0; flip < 1 + trial % 4; ++flip) {
        const std::uint64_t bits = random.bits({.frame = trial, .copy = flip});
        bytes[(bits >> 8) % bytes.size()] = static_cast<char>(bits & 0xff);
      }
      expect_valid_or_error(bytes);
    }
  }
}

TEST(DracoCodec, RefusesWhatIsNotADracoStream) {
  EXPECT_FALSE(decode_draco("", "empty"));
  EXPECT_FALSE(decode_draco("DRACO", "magic alone"));
  EXPECT_FALSE(decode_draco(std::string(4096, '\xff'), "noise"));
  EXPECT_FALSE(decode_draco("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "an OBJ file"));
}

TEST(DracoCodec, RefusesCountsThatTheStreamCannotHold) {
  const std::string stream = *encode_draco(example_cube());
  ASSERT_LT(stream[12], 127);  // both counts take one byte
  for (const std::size_t count : {12u, 13u}) {
    std::string bytes = stream;
    bytes.replace(count, 1, "\xff\xff\xff\xff\x07");
    const auto read = decode_draco(bytes, "lie.drc");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(read.error().message, HasSubstr("claims more triangles"));
  }
}

TEST(DracoCodec, TakesTheMostRegularOfMeshes) {
  const Mesh mesh = flat_grid(300);
  const auto stream = encode_draco(mesh);
  ASSERT_TRUE(stream);
  const auto read = decode_draco(*stream, "grid.drc");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->triangles.size(), mesh.triangles.size());
}

}  // namespace
}  // namespace seedframe
