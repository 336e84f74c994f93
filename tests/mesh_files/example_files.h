// Small meshes written in every format that can be read, by the plainest of means.
#pragma once

#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "mesh/mesh.h"

namespace seedframe {

template <class T>
void append_bytes(std::string& out, T value, bool big_endian = false) {
  std::array<char, sizeof(T)> raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  out.append(raw.data(), raw.size());
}

inline std::string obj_text(const Mesh& mesh) {
  std::string text;
  for (const auto& p : mesh.positions) text += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
  for (const auto& uv : mesh.corner_uvs) text += fmt::format("vt {} {}\n", uv[0], uv[1]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    text += fmt::format("usemtl {}\nf", mesh.slot_names[mesh.triangle_slots[t]]);
    for (std::size_t i = 0; i < 3; ++i) {
      text += fmt::format(" {}/{}", mesh.triangles[t][i] + 1, 3 * t + i + 1);
    }
    text += "\n";
  }
  return text;
}

inline std::string off_text(const Mesh& mesh) {
  std::string text =
      fmt::format("OFF\n# a part\n{} {} 0\n", mesh.positions.size(), mesh.triangles.size());
  for (const auto& p : mesh.positions) text += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

inline std::string stl_text(const Mesh& mesh) {
  std::string text = "solid part\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto v : triangle) {
      const auto& p = mesh.positions[v];
      text += fmt::format("vertex {} {} {}\n", p[0], p[1], p[2]);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

inline std::string stl_binary(const Mesh& mesh) {
  std::string bytes(80, ' ');
  append_bytes(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    bytes.append(12, '\0');
    for (const auto v : triangle) {
      for (const float x : mesh.positions[v]) append_bytes(bytes, x);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

/// With UVs and a material for each face.
inline std::string ply_header_text(const Mesh& mesh, const std::string& format) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment a part\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar int vertex_indices\n"
      "property list uchar float texcoord\nproperty uchar material_index\nend_header\n",
      format, mesh.positions.size(), mesh.triangles.size());
}

inline std::string ply_text(const Mesh& mesh) {
  std::string text = ply_header_text(mesh, "ascii");
  for (const auto& p : mesh.positions) text += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    text += fmt::format("3 {} {} {} 6", a, b, c);
    for (std::size_t i = 0; i < 3; ++i) {
      text += fmt::format(" {} {}", mesh.corner_uvs[3 * t + i][0], mesh.corner_uvs[3 * t + i][1]);
    }
    text += fmt::format(" {}\n", mesh.triangle_slots[t]);
  }
  return text;
}

inline std::string ply_binary(const Mesh& mesh, bool big_endian) {
  std::string bytes =
      ply_header_text(mesh, big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const auto& p : mesh.positions) {
    for (const float x : p) append_bytes(bytes, x, big_endian);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    append_bytes(bytes, std::uint8_t{3});
    for (const auto v : mesh.triangles[t]) append_bytes(bytes, v, big_endian);
    append_bytes(bytes, std::uint8_t{6});
    for (std::size_t i = 0; i < 3; ++i) {
      for (const float x : mesh.corner_uvs[3 * t + i]) append_bytes(bytes, x, big_endian);
    }
    append_bytes(bytes, static_cast<std::uint8_t>(mesh.triangle_slots[t]));
  }
  return bytes;
}

inline std::string base64(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

/// Corner by corner, a primitive for each slot; UVs with v down, as glTF has them.
inline std::string gltf_buffer(const Mesh& mesh) {
  std::string bytes;
  for (const auto& triangle : mesh.triangles) {
    for (const auto v : triangle) {
      for (const float x : mesh.positions[v]) append_bytes(bytes, x);
    }
  }
  for (const auto& uv : mesh.corner_uvs) {
    append_bytes(bytes, uv[0]);
    append_bytes(bytes, 1.0f - uv[1]);
  }
  for (std::uint32_t slot = 0; slot < mesh.slot_names.size(); ++slot) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.triangle_slots[t] != slot) continue;
      for (std::uint32_t i = 0; i < 3; ++i) append_bytes(bytes, 3 * t + i);
    }
  }
  return bytes;
}

/// `buffer` is what stands in buffers[0] besides its length: "" or "\"uri\": …,".
inline std::string gltf_json(const Mesh& mesh, const std::string& buffer) {
  const std::size_t corners = 3 * mesh.triangles.size();
  std::string views = fmt::format(
      R"({{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}})",
      12 * corners, 12 * corners, 8 * corners);
  std::string accessors =
      fmt::format(R"({{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
                  R"({{"bufferView":1,"componentType":5126,"count":{},"type":"VEC2"}})",
                  corners, corners);
  std::string primitives;
  std::string materials;
  std::size_t offset = 20 * corners;
  for (std::size_t slot = 0; slot < mesh.slot_names.size(); ++slot) {
    std::size_t count = 0;
    for (const auto used : mesh.triangle_slots) count += used == slot ? 3 : 0;
    views += fmt::format(R"(,{{"buffer":0,"byteOffset":{},"byteLength":{}}})", offset, 4 * count);
    accessors += fmt::format(
        R"(,{{"bufferView":{},"componentType":5125,"count":{},"type":"SCALAR"}})", slot + 2, count);
    primitives += fmt::format(
        R"({}{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"indices":{},"material":{}}})",
        slot == 0 ? "" : ",", slot + 2, slot);
    materials += fmt::format(R"({}{{"name":"{}"}})", slot == 0 ? "" : ",", mesh.slot_names[slot]);
    offset += 4 * count;
  }
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0,"translation":[0,0,0]}}],"meshes":[{{"primitives":[{}]}}],)"
      R"("materials":[{}],"accessors":[{}],"bufferViews":[{}],"buffers":[{{{}"byteLength":{}}}]}})",
      primitives, materials, accessors, views, buffer, offset);
}

inline std::string gltf_text(const Mesh& mesh) {
  return gltf_json(mesh, fmt::format(R"("uri":"data:application/octet-stream;base64,{}",)",
                                     base64(gltf_buffer(mesh))));
}

inline std::string glb_binary(const Mesh& mesh) {
  std::string json = gltf_json(mesh, "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = gltf_buffer(mesh);
  std::string bytes = "glTF";
  append_bytes(bytes, std::uint32_t{2});
  append_bytes(bytes, static_cast<std::uint32_t>(28 + json.size() + buffer.size()));
  append_bytes(bytes, static_cast<std::uint32_t>(json.size()));
  append_bytes(bytes, std::uint32_t{0x4e4f534a});
  bytes += json;
  append_bytes(bytes, static_cast<std::uint32_t>(buffer.size()));
  append_bytes(bytes, std::uint32_t{0x004e4942});
  return bytes + buffer;
}

struct ExampleFile {
  std::string name;
  std::string bytes;
};

inline std::vector<ExampleFile> example_files(const Mesh& mesh) {
  return {{"part.obj", obj_text(mesh)},        {"part.off", off_text(mesh)},
          {"part.stl", stl_text(mesh)},        {"binary.stl", stl_binary(mesh)},
          {"part.ply", ply_text(mesh)},        {"little.ply", ply_binary(mesh, false)},
          {"big.ply", ply_binary(mesh, true)}, {"part.gltf", gltf_text(mesh)},
          {"part.glb", glb_binary(mesh)}};
}

}  // namespace seedframe
