// The materials and images that mesh files name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "mesh_files/mesh_file.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/mesh/example_meshes.h"
#include "tests/mesh_files/example_files.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Materials : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "parts/images");
    write("parts/images/wood.png", "wood");
    write("parts/rough.png", "rough");
    write("secret.png", "secret");
  }

  void write(const std::string& name, const std::string& bytes) const {
    ASSERT_TRUE(write_file_unsynced(folder_ / name, bytes));
  }

  MeshFile read(const std::string& name, const std::string& bytes) {
    write("parts/" + name, bytes);
    auto file = read_mesh_file(folder_ / "parts" / name);
    EXPECT_TRUE(file) << file.error().message;
    return file ? std::move(*file) : MeshFile();
  }

  MeshFile read_obj_with(const std::string& mtl) {
    write("parts/part.mtl", mtl);
    return read("part.obj", "mtllib part.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl steel\nf 1 2 3\n");
  }

  const ScratchFolder folder_;
};

std::string bytes_of(const FileMaterial& material, const std::string& role) {
  const auto found = material.textures.find(role);
  if (found == material.textures.end() || !found->second.image) return "";
  return found->second.image->bytes;
}

TEST_F(Materials, OfObjFilesAreNumbersAndImages) {
  const MeshFile file = read_obj_with(
      "# a comment\nnewmtl other\nKd 1 0 0\nnewmtl steel\nKd 0.1 0.2 0.3\nNs 250\nPm 1\nd 0.5\n"
      "map_Pr -bm 1 rough.png\n");
  ASSERT_EQ(file.materials.count("steel"), 1u);
  const FileMaterial& steel = file.materials.at("steel");
  EXPECT_THAT(steel.base_color, ElementsAre(0.1, 0.2, 0.3));
  EXPECT_DOUBLE_EQ(steel.roughness, 0.5);
  EXPECT_EQ(steel.metallic, 1.0);
  EXPECT_EQ(steel.textures.at("alpha").factor, 0.5);
  EXPECT_EQ(bytes_of(steel, "roughness"), "rough");
  EXPECT_THAT(file.dropped, IsEmpty());
  EXPECT_THAT(file.not_kept, IsEmpty());
}

TEST_F(Materials, ImagesAreFoundByTheirNamesBesideTheMesh) {
  for (const std::string name :
       {"images/wood.png", "images\\wood.png", "-s 1 1 1 -blendu on images/wood.png"}) {
    const MeshFile file = read_obj_with("newmtl steel\nKd 0.5 0.5 0.5\nmap_Kd " + name + "\n");
    const FileMaterial& steel = file.materials.at("steel");
    EXPECT_EQ(bytes_of(steel, "color"), "wood") << name;
    EXPECT_THAT(file.not_kept, IsEmpty()) << name;
    EXPECT_THAT(steel.base_color, ElementsAre(1.0, 1.0, 1.0)) << "the image is the colour";
  }
  const MeshFile elsewhere = read_obj_with("newmtl steel\nmap_Kd C:\\Users\\somebody\\rough.png\n");
  EXPECT_EQ(bytes_of(elsewhere.materials.at("steel"), "color"), "rough");
}

TEST_F(Materials, NothingOutsideOfTheFolderIsOpened) {
  std::filesystem::create_symlink("../secret.png", folder_ / "parts/link.png");
  for (const std::string name : {"../secret.png", "link.png", "/etc/passwd", "missing.png"}) {
    const MeshFile file = read_obj_with("newmtl steel\nmap_Kd " + name + "\n");
    EXPECT_THAT(file.materials.at("steel").textures, IsEmpty()) << name;
    EXPECT_THAT(file.dropped,
                ElementsAre("images that cannot be read are left out: at '" + name + "'"));
  }
  const MeshFile file = read("a.obj", "mtllib ../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(file.dropped, ElementsAre(HasSubstr("files of materials that cannot be read")));
}

TEST_F(Materials, WhatIsNotKeptOfThemIsListed) {
  const MeshFile file = read_obj_with(
      "newmtl steel\nKe 1 1 1\nmap_Bump wood.png\nmap_Ks wood.png\nmap_Kd -o 0.5 0 0 "
      "images/wood.png\n");
  EXPECT_THAT(file.not_kept,
              ElementsAre("light that materials give off", "images of the kind 'map_Bump'",
                          "images of the kind 'map_Ks'", "where materials place their images"));
}

TEST_F(Materials, PlyFilesNameImagesInComments) {
  const std::string ply =
      "ply\nformat ascii 1.0\ncomment TextureFile images/wood.png\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(bytes_of(read("a.ply", ply).materials.at("default"), "color"), "wood");
}

TEST_F(Materials, OfGltfFilesAreNumbersAndChannels) {
  const std::string names = R"("materials":[{"name":"sides"},{"name":"caps"}])";
  const std::string materials =
      R"("images":[{"uri":"images/wood.png"},{"uri":"data:image/png;base64,cm91Z2g="},{"uri":"../secret.png"}],)"
      R"("textures":[{"source":0},{"source":1},{"source":2}],)"
      R"("materials":[{"name":"sides","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.6,0.7,0.8],)"
      R"("baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1},"roughnessFactor":0.5},)"
      R"("alphaMode":"MASK","alphaCutoff":0.25,"extensions":{"KHR_materials_ior":{"ior":1.33},)"
      R"("KHR_materials_sheen":{}}},{"name":"caps","normalTexture":{"index":2},"emissiveFactor":[1,0,0]}])";
  std::string text = gltf_text(example_cube());
  ASSERT_NE(text.find(names), std::string::npos);
  text.replace(text.find(names), names.size(), materials);
  const MeshFile file = read("a.gltf", text);
  const FileMaterial& sides = file.materials.at("sides");
  EXPECT_THAT(sides.base_color, ElementsAre(0.5, 0.6, 0.7));
  EXPECT_EQ(sides.ior, 1.33);
  EXPECT_EQ(bytes_of(sides, "color"), "wood");
  EXPECT_FALSE(sides.textures.at("color").channel);
  EXPECT_EQ(bytes_of(sides, "roughness"), "rough");
  EXPECT_EQ(sides.textures.at("roughness").channel, 1);
  EXPECT_EQ(sides.textures.at("roughness").factor, 0.5);
  EXPECT_EQ(sides.textures.at("metallic").channel, 2);
  EXPECT_EQ(bytes_of(sides, "alpha"), "wood");
  EXPECT_EQ(sides.textures.at("alpha").channel, 3);
  EXPECT_EQ(sides.textures.at("alpha").factor, 0.8);
  EXPECT_EQ(sides.textures.at("alpha").cutoff, 0.25);
  const FileMaterial& caps = file.materials.at("caps");
  EXPECT_EQ(caps.metallic, 1.0) << "as the standard has it";
  EXPECT_THAT(caps.textures, IsEmpty());
  EXPECT_THAT(file.dropped, ElementsAre("images that cannot be read are left out: at images[2]"));
  EXPECT_THAT(file.not_kept, ElementsAre("the extension KHR_materials_sheen of materials",
                                         "light that materials give off"));
}

TEST_F(Materials, TwoOfOneNameStayTwo) {
  std::string text = gltf_text(example_cube());
  const std::string caps = R"({"name":"caps"})";
  text.replace(text.find(caps), caps.size(), R"({"name":"sides"})");
  EXPECT_THAT(read("a.gltf", text).mesh.slot_names, ElementsAre("sides", "sides (1)"));
}

}  // namespace
}  // namespace seedframe
