#include "mesh/mesh_buffer.h"

#include <bit>
#include <cassert>
#include <cstring>
#include <span>
#include <vector>

namespace seedframe {
namespace {

static_assert(std::endian::native == std::endian::little, "mesh buffers are little-endian");

constexpr std::string_view kMagic = "SFMESH01";
constexpr std::size_t kHeaderBytes = kMagic.size() + 16;
constexpr std::size_t kBytesPerVertex = 12;
constexpr std::size_t kBytesPerTriangle = 12 + 24 + 4;

template <class T>
void append(std::string& bytes, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

template <class T>
void append(std::string& bytes, const T& value) {
  append(bytes, std::span<const T>(&value, 1));
}

// Takes values off the front of `bytes`, whose length has been checked.
template <class T>
void take(std::string_view& bytes, std::span<T> values) {
  if (values.empty()) return;  // memcpy wants an address even for no bytes
  std::memcpy(values.data(), bytes.data(), values.size_bytes());
  bytes.remove_prefix(values.size_bytes());
}

template <class T>
T take(std::string_view& bytes) {
  T value{};
  take(bytes, std::span<T>(&value, 1));
  return value;
}

}  // namespace

std::string mesh_buffer(const Mesh& mesh) {
  assert(check_mesh(mesh, "mesh").has_value());
  std::string bytes;
  bytes.reserve(kHeaderBytes + kBytesPerVertex * mesh.positions.size() +
                kBytesPerTriangle * mesh.triangles.size());
  bytes += kMagic;
  append(bytes, static_cast<std::uint32_t>(mesh.positions.size()));
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  append(bytes, static_cast<std::uint32_t>(mesh.slot_names.size()));
  append(bytes, static_cast<float>(mesh.smooth_angle_rad));
  append(bytes, std::span(mesh.positions));
  append(bytes, std::span(mesh.triangles));
  append(bytes, std::span(mesh.corner_uvs));
  append(bytes, std::span(mesh.triangle_slots));
  return bytes;
}

Result<Mesh> mesh_from_buffer(std::string_view bytes, const std::string& what) {
  if (bytes.size() < kHeaderBytes || !bytes.starts_with(kMagic)) {
    return fail(ErrorKind::kCorrupt, "{} is not a mesh buffer of version 1 ({} bytes)", what,
                bytes.size());
  }
  std::string_view rest = bytes.substr(kMagic.size());
  const auto vertices = take<std::uint32_t>(rest);
  const auto triangles = take<std::uint32_t>(rest);
  const auto slots = take<std::uint32_t>(rest);
  const auto smooth_angle = take<float>(rest);
  const std::uint64_t expected = kHeaderBytes + kBytesPerVertex * std::uint64_t{vertices} +
                                 kBytesPerTriangle * std::uint64_t{triangles};
  if (bytes.size() != expected) {
    return fail(ErrorKind::kCorrupt,
                "{}: {} vertices and {} triangles take {} bytes, but there are {}", what, vertices,
                triangles, expected, bytes.size());
  }
  constexpr std::uint32_t kMostSlots = 1u << 15;
  if (slots > kMostSlots) {
    return fail(ErrorKind::kCorrupt, "{}: {} material slots are more than {}", what, slots,
                kMostSlots);
  }
  Mesh mesh;
  mesh.smooth_angle_rad = smooth_angle;
  mesh.positions.resize(vertices);
  mesh.triangles.resize(triangles);
  mesh.corner_uvs.resize(std::size_t{3} * triangles);
  mesh.triangle_slots.resize(triangles);
  take(rest, std::span(mesh.positions));
  take(rest, std::span(mesh.triangles));
  take(rest, std::span(mesh.corner_uvs));
  take(rest, std::span(mesh.triangle_slots));
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    mesh.slot_names.push_back(fmt::format("slot{}", slot));
  }
  if (Status status = check_mesh(mesh, what); !status) {
    return fail(ErrorKind::kCorrupt, "{}", status.error().message);
  }
  return mesh;
}

}  // namespace seedframe
