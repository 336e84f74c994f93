#include "mesh_files/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/files.h"
#include "mesh/mesh_measure.h"
#include "mesh/mesh_repair.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/mesh/example_meshes.h"
#include "tests/mesh_files/example_files.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class MeshFiles : public ::testing::Test {
 protected:
  Result<Mesh> read(const std::string& name, const std::string& bytes,
                    std::optional<UpAxis> up = std::nullopt) {
    EXPECT_TRUE(write_file_unsynced(folder_ / name, bytes));
    auto file = read_mesh_file(folder_ / name, {.up = up});
    if (!file) return forward_error(file);
    return std::move(file->mesh);
  }

  void expect_error(const std::string& name, const std::string& bytes, const std::string& reason) {
    const auto mesh = read(name, bytes);
    ASSERT_FALSE(mesh) << name;
    EXPECT_EQ(mesh.error().kind, ErrorKind::kInput);
    EXPECT_THAT(mesh.error().message, HasSubstr(name));
    EXPECT_THAT(mesh.error().message, HasSubstr(reason));
  }

  ScratchFolder folder_;
};

TEST_F(MeshFiles, EveryFormatGivesTheSameClosedCube) {
  const Mesh cube = example_cube();
  for (const ExampleFile& file : example_files(cube)) {
    const auto mesh = read(file.name, file.bytes, UpAxis::kZ);
    ASSERT_TRUE(mesh) << file.name << ": " << mesh.error().message;
    EXPECT_EQ(mesh->positions.size(), 8u) << file.name;
    EXPECT_EQ(mesh->triangles.size(), 12u) << file.name;
    EXPECT_TRUE(measure_mesh(*mesh).watertight) << file.name;
    EXPECT_DOUBLE_EQ(signed_volume_6(*mesh), 48.0) << file.name;
  }
}

TEST_F(MeshFiles, FormatsWithUvsAndMaterialsKeepThem) {
  const Mesh cube = example_cube();
  for (const ExampleFile& file : example_files(cube)) {
    const bool has_uvs = file.name.ends_with("obj") || file.name.ends_with("ply") ||
                         file.name.ends_with("gltf") || file.name.ends_with("glb");
    if (!has_uvs) continue;
    const auto mesh = read(file.name, file.bytes, UpAxis::kZ);
    ASSERT_TRUE(mesh) << file.name;
    EXPECT_EQ(mesh->slot_names.size(), 2u) << file.name;
    EXPECT_EQ(mesh->triangle_slots, cube.triangle_slots) << file.name;
    for (std::size_t i = 0; i < cube.corner_uvs.size(); ++i) {
      EXPECT_FLOAT_EQ(mesh->corner_uvs[i][0], cube.corner_uvs[i][0]) << file.name;
      EXPECT_FLOAT_EQ(mesh->corner_uvs[i][1], cube.corner_uvs[i][1]) << file.name;
    }
  }
}

TEST_F(MeshFiles, GltfIsTurnedToZUpAndOthersOnDemand) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 5 0\nf 1 2 3\n";
  EXPECT_FLOAT_EQ(static_cast<float>(bounding_box(*read("a.obj", obj)).high.y()), 5.0f);
  EXPECT_FLOAT_EQ(static_cast<float>(bounding_box(*read("a.obj", obj, UpAxis::kY)).high.z()), 5.0f);
  Mesh tall = example_patch(2);
  for (auto& p : tall.positions) p = {p[0], 7.0f * p[1], 0.0f};
  const auto turned = read("a.gltf", gltf_text(tall));
  ASSERT_TRUE(turned) << turned.error().message;
  EXPECT_NEAR(bounding_box(*turned).high.z(), 1.4, 1e-6);
}

TEST_F(MeshFiles, GltfNodesPlaceScaleAndMirrorTheirMeshes) {
  std::string text = gltf_text(example_cube());
  const std::string plain = R"("translation":[0,0,0])";
  text.replace(text.find(plain), plain.size(), R"("translation":[10,0,0],"scale":[-2,1,1])");
  const auto mesh = read("a.gltf", text, UpAxis::kZ);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_DOUBLE_EQ(bounding_box(*mesh).low.x(), 8.0);
  EXPECT_DOUBLE_EQ(bounding_box(*mesh).high.x(), 12.0);
  EXPECT_DOUBLE_EQ(signed_volume_6(*mesh), 96.0) << "a mirrored mesh must not be inside out";
}

TEST_F(MeshFiles, GltfTakesBase64AsBrowsersDo) {
  const Mesh cube = example_cube();
  const auto read_text = [&](const std::string& text) {
    const std::string uri = R"("uri":"data:application/octet-stream;base64,)" + text + R"(",)";
    return read("a.gltf", gltf_json(cube, uri));
  };
  std::string bytes = gltf_buffer(cube);
  bytes += bytes.size() % 3 == 0 ? "x" : "";  // so that its text ends in '='
  const std::string text = base64(bytes);
  const std::string digits = text.substr(0, text.find_last_not_of('=') + 1);
  ASSERT_LT(digits.size(), text.size());
  for (const std::string& good : {text, digits, digits + "====="}) {
    const auto mesh = read_text(good);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 12u);
  }
  for (const std::string& bad :
       {" " + text, "    " + text, text + " ", text + "    ", text + "\\n", "=" + text,
        text.substr(0, 4) + "AB==" + text.substr(4), text.substr(0, 4) + " " + text.substr(4),
        "-" + text, text.substr(0, 8) + "-_" + text.substr(10), text.substr(0, 8) + "ä" + text,
        text.substr(0, 8) + "    ", text.substr(0, 8) + "\\n\\n\\n\\n"}) {
    const auto mesh = read_text(bad);
    ASSERT_FALSE(mesh) << bad;
    EXPECT_THAT(mesh.error().message, HasSubstr("expected data in base64")) << bad;
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{3},
                                   std::size_t{5}, digits.size() / 2, digits.size() - 5}) {
    const auto mesh = read_text(text.substr(0, length));
    ASSERT_FALSE(mesh) << length;
    EXPECT_THAT(mesh.error().message, HasSubstr(fmt::format("promised, {} found", length * 3 / 4)));
  }
}

TEST_F(MeshFiles, GltfDecodesEscapedNamesOfFiles) {
  ASSERT_TRUE(write_file(folder_ / "a b%2.bin", gltf_buffer(example_cube())));
  const auto mesh = read("a.gltf", gltf_json(example_cube(), R"("uri":"a%20%62%2.bin",)"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 12u);
}

TEST_F(MeshFiles, GltfOpensNoFilesOutsideItsFolder) {
  ASSERT_TRUE(write_file(folder_ / "secret.bin", gltf_buffer(example_cube())));
  std::filesystem::create_directories(folder_ / "sub");
  for (const char* uri : {"../secret.bin", "%2e%2e/secret.bin", "/etc/passwd", "http://a/b"}) {
    const std::string json = gltf_json(example_cube(), fmt::format(R"("uri":"{}",)", uri));
    expect_error("sub/a.gltf", json, "is not a file in the folder");
  }
  ASSERT_TRUE(write_file(folder_ / "sub/own.bin", gltf_buffer(example_cube())));
  EXPECT_TRUE(read("sub/a.gltf", gltf_json(example_cube(), R"("uri":"own.bin",)")));
}

TEST_F(MeshFiles, GltfFollowsNoLinksOutOfItsFolderAndWaitsForNoPipe) {
  std::filesystem::create_directories(folder_ / "sub");
  ASSERT_TRUE(write_file(folder_ / "secret.bin", gltf_buffer(example_cube())));
  std::filesystem::create_symlink("../secret.bin", folder_ / "sub/link.bin");
  std::filesystem::create_symlink("..", folder_ / "sub/up");
  std::filesystem::create_symlink("/dev/zero", folder_ / "sub/zero.bin");
  ASSERT_EQ(::mkfifo((folder_ / "sub/pipe.bin").c_str(), 0600), 0);
  for (const char* uri : {"link.bin", "up/secret.bin", "zero.bin", "pipe.bin"}) {
    const std::string json = gltf_json(example_cube(), fmt::format(R"("uri":"{}",)", uri));
    expect_error("sub/a.gltf", json, "is not a file in the folder");
  }
}

TEST_F(MeshFiles, DeepJsonIsAnError) {
  for (const char* bracket : {"[", "{\"a\":"}) {
    std::string deep;
    for (int i = 0; i < 2'000'000; ++i) deep += bracket;
    expect_error("a.gltf", deep, "a.gltf");
    expect_error("b.gltf", R"({"asset":{"version":)" + deep, "b.gltf");
  }
  expect_error(
      "c.gltf",
      R"({"asset":{"version":)" + std::string(2'000'000, '[') + std::string(2'000'000, ']') + "}}",
      "c.gltf");
}

TEST_F(MeshFiles, GltfLoopsExtensionsAndRangesAreErrors) {
  std::string loop = gltf_text(example_cube());
  const std::string mesh_node = R"("mesh":0)";
  loop.replace(loop.find(mesh_node), mesh_node.size(), R"("mesh":0,"children":[0])");
  expect_error("a.gltf", loop, "a child of two nodes");
  std::string draco = gltf_text(example_cube());
  draco.insert(1, R"("extensionsRequired":["KHR_draco_mesh_compression"],)");
  expect_error("a.gltf", draco, "KHR_draco_mesh_compression");
  std::string huge = gltf_text(example_cube());
  const std::string count = R"("count":36)";
  huge.replace(huge.find(count), count.size(), R"("count":9007199254740991)");
  expect_error("a.gltf", huge, "end beyond");
}

TEST_F(MeshFiles, EveryTruncationIsAnErrorOrAValidMesh) {
  for (const ExampleFile& file : example_files(example_cube())) {
    for (std::size_t length = 0; length < file.bytes.size(); ++length) {
      const auto mesh = read(file.name, file.bytes.substr(0, length));
      // Without a count in the file, a cut between two lines cannot be told.
      const bool counted = !file.name.ends_with("obj");
      if (counted && length + 16 < file.bytes.size()) {
        EXPECT_FALSE(mesh) << file.name << length;
      }
      if (mesh) {
        EXPECT_TRUE(check_mesh(*mesh, file.name));
      }
    }
  }
}

TEST_F(MeshFiles, ClaimsOfHeadersCostNothing) {
  std::string stl(80, ' ');
  append_bytes(stl, std::uint32_t{0xffffffff});
  expect_error("a.stl", stl, "cut short");
  expect_error("a.off", "OFF\n4000000000 4000000000 0\n", "cut short: 4000000000 vertices");
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 18000000000000000000\n";
  expect_error("a.ply", ply + "property float x\nproperty float y\nproperty float z\nend_header\n",
               "expected 'x', found the end of the file");
  expect_error("a.ply", ply + "end_header\n", "has no polygons");
  expect_error("a.ply",
               "ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
               "property list uint double x\nend_header\n\xff\xff\xff\xff",
               "x, y and z");
}

TEST_F(MeshFiles, PolygonsBeyondTheLimitAreErrors) {
  std::string off = fmt::format("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n{}", 5000);
  for (int i = 0; i < 5000; ++i) off += fmt::format(" {}", i % 3);
  expect_error("a.off", off + "\n", "more than 1024");
}

TEST_F(MeshFiles, SaysWhatItCannotRead) {
  expect_error("a.fbx", "Kaydara", "expected .obj, .ply, .stl, .off, .gltf or .glb");
  expect_error("a.stl", "", "0 bytes are not an STL file");
  expect_error("a.off", "", "empty");
  expect_error("a.ply", "plz\n", "expected 'ply'");
  expect_error("a.glb", "glTF", "version 2");
  expect_error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "a.off:4");
  expect_error("a.stl", "solid\nfacet\nouter loop\nvertex 0 0 x\n", "a.stl:4");
  EXPECT_FALSE(read_mesh_file(folder_ / "missing.ply"));
}

TEST_F(MeshFiles, AsciiStlMayBeginWithBlankLinesOrAByteOrderMark) {
  const std::string text = stl_text(example_cube());
  for (const std::string start : {"  \n", "\r\n\t", "\xEF\xBB\xBF"}) {
    const auto mesh = read("a.stl", start + text);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 12u);
  }
}

TEST_F(MeshFiles, GltfExtensionsOfTexturesDoNotMatter) {
  std::string text = gltf_text(example_cube());
  for (const std::string name : {"KHR_texture_transform", "EXT_texture_webp", "MSFT_texture_dds",
                                 "ADOBE_materials_thin_transparency", "EXT_lights_ies"}) {
    EXPECT_TRUE(read("a.gltf", R"({"extensionsRequired":[")" + name + R"("],)" + text.substr(1)));
  }
}

TEST_F(MeshFiles, WhatAFileBeginsWithWinsOverItsName) {
  EXPECT_TRUE(read("a.stl", ply_text(example_cube())));
  EXPECT_TRUE(read("a.obj", glb_binary(example_cube())));
}

}  // namespace
}  // namespace seedframe
