// Files as strangers' programs write them: what can be read is, and what is left out is told.
#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/files.h"
#include "mesh_files/mesh_file.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/mesh/example_meshes.h"
#include "tests/mesh_files/example_files.h"

namespace seedframe {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class StrangeFiles : public ::testing::Test {
 protected:
  Result<MeshFile> read(const std::string& name, const std::string& bytes,
                        const MeshFileOptions& options = {}) {
    EXPECT_TRUE(write_file_unsynced(folder_ / name, bytes));
    return read_mesh_file(folder_ / name, options);
  }

  ScratchFolder folder_;
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  EXPECT_NE(text.find(what), std::string::npos) << what;
  return text.replace(text.find(what), what.size(), by);
}

std::string as_utf16(const std::string& text, bool big_endian, bool mark) {
  std::string bytes = mark ? (big_endian ? "\xFE\xFF" : "\xFF\xFE") : "";
  for (const char c : text) bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

TEST_F(StrangeFiles, Utf16IsNamed) {
  for (const ExampleFile& file : example_files(example_cube())) {
    const bool is_text = file.name.starts_with("part.") && file.name != "part.glb";
    if (!is_text) continue;
    for (const bool big_endian : {false, true}) {
      for (const bool mark : {false, true}) {
        const auto mesh = read(file.name, as_utf16(file.bytes, big_endian, mark));
        ASSERT_FALSE(mesh) << file.name;
        EXPECT_THAT(mesh.error().message, HasSubstr("is text in UTF-16: save it as UTF-8"))
            << file.name;
      }
    }
  }
}

TEST_F(StrangeFiles, AByteOrderMarkIsNoPartOfTheText) {
  for (const ExampleFile& file : example_files(example_cube())) {
    if (file.name == "binary.stl" || file.name == "part.glb") continue;
    const auto mesh = read(file.name, "\xEF\xBB\xBF" + file.bytes);
    ASSERT_TRUE(mesh) << file.name << ": " << mesh.error().message;
    EXPECT_EQ(mesh->mesh.positions.size(), 8u) << file.name;
    EXPECT_THAT(mesh->dropped, IsEmpty()) << file.name;
  }
}

TEST_F(StrangeFiles, NamesInLatin1AreTakenOver) {
  Mesh cube = example_cube();
  cube.slot_names = {"Geh\xE4use", "Gr\xFC\xDF"};
  for (const ExampleFile& file :
       {ExampleFile{"a.obj", obj_text(cube)}, ExampleFile{"a.gltf", gltf_text(cube)},
        ExampleFile{"a.glb", glb_binary(cube)}}) {
    const auto mesh = read(file.name, file.bytes);
    ASSERT_TRUE(mesh) << file.name << ": " << mesh.error().message;
    EXPECT_THAT(mesh->mesh.slot_names, ElementsAre("Gehäuse", "Grüß")) << file.name;
  }
}

TEST_F(StrangeFiles, AsciiStlMayShoutAndBeIndented) {
  std::string text = stl_text(example_cube());
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const std::string start : {"", " ", "\t"}) {
    const auto mesh = read("a.stl", start + text);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->mesh.triangles.size(), 12u);
  }
}

TEST_F(StrangeFiles, OptionalNumbersThatAreWrongCostNoMesh) {
  const Mesh cube = example_cube();
  const std::string off = "STOFF\n3 1 0\n0 0 0 nan 1\n1 0 0 1 1\n0 1 0 x 0\n3 0 1 2 junk\n";
  const std::string ply_uvs =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float s\nproperty float t\nproperty uchar red\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 nan 0 255\n1 0 0 1 1 -1.#IND\n0 1 0 0 1 many\n3 0 1 2\n";
  for (const ExampleFile& file :
       {ExampleFile{"a.obj", replaced(obj_text(cube), "vt 1 0", "vt 1 nan")},
        ExampleFile{"b.obj", replaced(obj_text(cube), "vt 1 0", "vt one 0")},
        ExampleFile{"a.off", off}, ExampleFile{"a.ply", ply_uvs},
        ExampleFile{"b.ply", replaced(ply_text(cube), " 6 0 0 ", " 5 0 ")},
        ExampleFile{"c.ply", replaced(ply_text(cube), " 1 1 1\n", " 1 1 99999999\n")},
        ExampleFile{"a.gltf", replaced(gltf_text(cube), "VEC2", "VEC3")},
        ExampleFile{"b.gltf", replaced(gltf_text(cube), R"("TEXCOORD_0":1)", R"("TEXCOORD_0":77)")},
        ExampleFile{"c.gltf", replaced(gltf_text(cube), R"("TEXCOORD_0":1)", R"("TEXCOORD_0":2)")},
        ExampleFile{"d.gltf", replaced(gltf_text(cube), R"("material":0)", R"("material":7)")},
        ExampleFile{"e.gltf", replaced(gltf_text(cube), R"("material":0)", R"("material":"x")")}}) {
    const auto mesh = read(file.name, file.bytes);
    ASSERT_TRUE(mesh) << file.name << ": " << mesh.error().message;
    EXPECT_EQ(mesh->dropped.size(), 1u) << file.name;
  }
  EXPECT_THAT(read("a.off", off)->dropped,
              ElementsAre("UVs that are not finite numbers are (0, 0) instead: 2 of them, the "
                          "first at line 3"));
}

TEST_F(StrangeFiles, WhatAnAssetCannotHoldIsListed) {
  const std::string vertices = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nvn 0 0 1\n";
  EXPECT_THAT(read("a.obj", vertices + "f 1//1 2//1 3//1\nl 1 2\n")->not_kept,
              ElementsAre(HasSubstr("normals"), "points and lines"));
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nproperty float nx\nproperty uchar red\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty uchar red\nelement edge 1\n"
      "property int vertex1\nend_header\n0 0 0 0 9\n1 0 0 0 9\n0 1 0 0 9\n3 0 1 2 9\n0\n";
  EXPECT_THAT(read("a.ply", ply)->not_kept,
              ElementsAre(HasSubstr("normals"), "the element 'edge'"));
  EXPECT_THAT(read("a.off", "COFF\n3 1 0\n0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2\n")->not_kept,
              ElementsAre("vertex colours"));
  std::string stl = stl_binary(example_cube());
  EXPECT_THAT(read("a.stl", stl)->not_kept, IsEmpty());
  stl[84 + 49] = '\x80';
  EXPECT_THAT(read("a.stl", stl)->not_kept, ElementsAre("colours of triangles"));
  std::string gltf = gltf_text(example_cube());
  EXPECT_THAT(read("a.gltf", gltf)->not_kept, IsEmpty());
  gltf = replaced(gltf, R"("TEXCOORD_0":1)", R"("TEXCOORD_0":1,"COLOR_0":0,"NORMAL":0)");
  gltf = replaced(gltf, R"("scene":0)", R"("animations":[],"scene":0)");
  EXPECT_THAT(read("a.gltf", gltf)->not_kept, ElementsAre(HasSubstr("normals"), "animations"));
}

// A cube of 0.1 m, its corner at the given place.
Mesh small_cube() {
  Mesh mesh = example_cube();
  for (auto& p : mesh.positions) {
    for (float& value : p) value = value < 0.0f ? 0.0f : 0.1f;
  }
  return mesh;
}

std::string far_obj(const Mesh& mesh, const Eigen::Vector3d& at) {
  std::string text;
  for (const auto& p : mesh.positions) {
    text += fmt::format("v {:.4f} {:.4f} {:.4f}\n", at.x() + static_cast<double>(p[0]),
                        at.y() + static_cast<double>(p[1]), at.z() + static_cast<double>(p[2]));
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return text;
}

TEST_F(StrangeFiles, CoordinatesFarFromTheOriginKeepTheirDigits) {
  const Eigen::Vector3d utm(500000.0, 5400000.0, 30.0);
  // A stray vertex at the origin must not make the part look large.
  for (const std::string stray : {"", "v 0 0 0\n"}) {
    const auto file = read("a.obj", far_obj(small_cube(), utm) + stray);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR((file->origin_m - utm - Eigen::Vector3d::Constant(0.05)).norm(), 0.0, 1e-9);
    Mesh mesh = file->mesh;
    mesh.positions.resize(8);
    for (const double side : bounding_box(mesh).size()) EXPECT_NEAR(side, 0.1, 1e-8);
    EXPECT_LT(file->rounding_m, 1e-8);
    EXPECT_GT(file->rounding_m, 0.0);
  }
  const auto turned = read("a.obj", far_obj(small_cube(), utm), {.up = UpAxis::kY, .scale = 0.5});
  ASSERT_TRUE(turned);
  EXPECT_NEAR(turned->origin_m.x(), 250000.025, 1e-9);
  EXPECT_NEAR(turned->origin_m.y(), -15.025, 1e-9);
  EXPECT_NEAR(turned->origin_m.z(), 2700000.025, 1e-9);
}

TEST_F(StrangeFiles, PartsNearTheOriginStayWhereTheyAre) {
  const auto file = read("a.obj", far_obj(small_cube(), {2.0, -1.0, 0.5}));
  ASSERT_TRUE(file);
  EXPECT_EQ(file->origin_m, Eigen::Vector3d::Zero());
  EXPECT_NEAR(bounding_box(file->mesh).low.x(), 2.0, 1e-6);
  EXPECT_LT(file->rounding_m, 5e-7);
}

TEST_F(StrangeFiles, WhatAFileItselfHasLostIsTold) {
  Mesh far = small_cube();
  for (auto& p : far.positions) p[0] = p[0] * 1e6f + 5e6f;
  const auto stl = read("a.stl", stl_binary(far));
  ASSERT_TRUE(stl) << stl.error().message;
  EXPECT_EQ(stl->spacing_m, 0.5) << "of a float of 5,100,000";
  EXPECT_EQ(read("a.stl", stl_text(far))->spacing_m, 0.0);
  EXPECT_EQ(read("a.ply", ply_binary(far, true))->spacing_m, 0.5);
  EXPECT_EQ(read("a.glb", glb_binary(far))->spacing_m, 0.5);
  EXPECT_LT(read("a.stl", stl_binary(small_cube()))->spacing_m, 1e-7);
}

TEST_F(StrangeFiles, WhatIsNoFileIsNotWaitedFor) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder_ / "zero.ply");
  for (const char* name : {"pipe.obj", "zero.ply"}) {
    const auto mesh = read_mesh_file(folder_ / name);
    ASSERT_FALSE(mesh) << name;
    EXPECT_EQ(mesh.error().kind, ErrorKind::kInput);
    EXPECT_THAT(mesh.error().message, HasSubstr("it is a device, a pipe or a socket"));
  }
}

}  // namespace
}  // namespace seedframe
