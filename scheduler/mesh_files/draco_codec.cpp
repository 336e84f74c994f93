#include "mesh_files/draco_codec.h"

#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <memory>

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include "mesh_files/draco_header.h"

namespace seedframe {
namespace {

using draco::AttributeValueIndex;
using draco::GeometryAttribute;
using draco::PointAttribute;
using draco::PointIndex;

// The slot of a triangle, stored at each of its corners.
constexpr auto kSlotAttribute = GeometryAttribute::GENERIC;

// The attribute values of one Draco point: indices of a position, a UV and a slot.
using PointKey = std::array<std::uint32_t, 3>;

// Corners that agree in position, UV and slot are one Draco point.
struct Points {
  std::vector<std::array<float, 2>> uvs;
  std::vector<std::array<std::uint32_t, 1>> slots;  // those that triangles have, in order
  std::vector<PointKey> keys;
  std::vector<draco::Mesh::Face> faces;
};

// Draco must not be given values that no point has: its encoder then throws std::bad_alloc. Returns
// the index in `values` of each slot.
std::vector<std::uint32_t> collect_slots(const Mesh& mesh,
                                         std::vector<std::array<std::uint32_t, 1>>& values) {
  std::vector<std::uint32_t> index(mesh.slot_names.size(), 0);
  for (const std::uint32_t slot : mesh.triangle_slots) index[slot] = 1;
  for (std::uint32_t slot = 0; slot < index.size(); ++slot) {
    if (index[slot] == 0) continue;
    index[slot] = static_cast<std::uint32_t>(values.size());
    values.push_back({slot});
  }
  return index;
}

Points collect_points(const Mesh& mesh) {
  Points points;
  std::map<std::array<float, 2>, std::uint32_t> uv_indices;
  std::map<PointKey, std::uint32_t> point_indices;
  const std::vector<std::uint32_t> slot_indices = collect_slots(mesh, points.slots);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    draco::Mesh::Face face;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto& uv = mesh.corner_uvs[3 * t + corner];
      const auto [uv_entry, new_uv] =
          uv_indices.try_emplace(uv, static_cast<std::uint32_t>(points.uvs.size()));
      if (new_uv) points.uvs.push_back(uv);
      const PointKey key{mesh.triangles[t][corner], uv_entry->second,
                         slot_indices[mesh.triangle_slots[t]]};
      const auto [point_entry, new_point] =
          point_indices.try_emplace(key, static_cast<std::uint32_t>(points.keys.size()));
      if (new_point) points.keys.push_back(key);
      face[corner] = PointIndex(point_entry->second);
    }
    points.faces.push_back(face);
  }
  return points;
}

// `which` is the place in a PointKey of the index into `values`.
template <class T, std::size_t N>
int add_attribute(draco::Mesh& out, GeometryAttribute::Type type, draco::DataType data_type,
                  const std::vector<std::array<T, N>>& values, const std::vector<PointKey>& keys,
                  std::size_t which) {
  auto attribute = std::make_unique<PointAttribute>();
  attribute->Init(type, static_cast<std::int8_t>(N), data_type, false, values.size());
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    attribute->SetAttributeValue(AttributeValueIndex(i), values[i].data());
  }
  attribute->SetExplicitMapping(keys.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    attribute->SetPointMapEntry(PointIndex(i), AttributeValueIndex(keys[i][which]));
  }
  return out.AddAttribute(std::move(attribute));
}

// A stream is damaged in ways that Draco does not notice: it checks neither types nor indices.
template <class T, std::size_t N>
bool is_readable(const PointAttribute* attribute, draco::DataType type, std::uint32_t points) {
  if (attribute == nullptr || attribute->data_type() != type) return false;
  if (attribute->num_components() != N || attribute->buffer() == nullptr) return false;
  if (attribute->byte_stride() != static_cast<std::int64_t>(sizeof(T) * N)) return false;
  if (attribute->buffer()->data_size() < attribute->size() * sizeof(T) * N) return false;
  if (!attribute->is_mapping_identity() && attribute->indices_map_size() < points) return false;
  for (std::uint32_t i = 0; i < points; ++i) {
    if (attribute->mapped_index(PointIndex(i)).value() >= attribute->size()) return false;
  }
  return true;
}

template <class T, std::size_t N>
std::array<T, N> value_at(const PointAttribute& attribute, PointIndex point) {
  return attribute.GetValue<T, N>(attribute.mapped_index(point));
}

Result<std::unique_ptr<draco::Mesh>> decode(std::string_view bytes, const std::string& what) {
  if (const char* fault = draco_header_fault(bytes)) {
    return fail(ErrorKind::kCorrupt, "{} is not a readable Draco mesh: {}", what, fault);
  }
  // Draco, and the allocations that a damaged count asks of it, may throw.
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (decoded.ok()) return std::move(decoded).value();
    return fail(ErrorKind::kCorrupt, "{} is not a readable Draco mesh: {}", what,
                decoded.status().error_msg_string());
  } catch (const std::exception& error) {
    return fail(ErrorKind::kCorrupt, "{} is not a readable Draco mesh: {}", what, error.what());
  }
}

Status check_attributes(const draco::Mesh& in, const std::string& what) {
  const std::uint32_t points = in.num_points();
  const auto* slots = in.GetNamedAttribute(kSlotAttribute);
  const bool good =
      is_readable<float, 3>(in.GetNamedAttribute(GeometryAttribute::POSITION), draco::DT_FLOAT32,
                            points) &&
      is_readable<float, 2>(in.GetNamedAttribute(GeometryAttribute::TEX_COORD), draco::DT_FLOAT32,
                            points) &&
      (slots == nullptr || is_readable<std::uint32_t, 1>(slots, draco::DT_UINT32, points));
  if (!good) {
    return fail(ErrorKind::kCorrupt,
                "{}: expected positions (3 floats), UVs (2 floats) and at most one slot number",
                what);
  }
  return {};
}

Status check_faces(const draco::Mesh& in, const std::string& what) {
  for (std::uint32_t f = 0; f < in.num_faces(); ++f) {
    for (const PointIndex& point : in.face(draco::FaceIndex(f))) {
      if (point.value() < in.num_points()) continue;
      return fail(ErrorKind::kCorrupt, "{}: triangle {} names point {} of {}", what, f,
                  point.value(), in.num_points());
    }
  }
  return {};
}

void copy_triangles(const draco::Mesh& in, Mesh& mesh) {
  const auto& positions = *in.GetNamedAttribute(GeometryAttribute::POSITION);
  const auto& uvs = *in.GetNamedAttribute(GeometryAttribute::TEX_COORD);
  const auto* slots = in.GetNamedAttribute(kSlotAttribute);
  for (std::uint32_t f = 0; f < in.num_faces(); ++f) {
    const draco::Mesh::Face& face = in.face(draco::FaceIndex(f));
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      triangle[corner] = positions.mapped_index(face[corner]).value();
      mesh.corner_uvs.push_back(value_at<float, 2>(uvs, face[corner]));
    }
    mesh.triangles.push_back(triangle);
    const auto slot = slots == nullptr ? 0 : value_at<std::uint32_t, 1>(*slots, face[0])[0];
    mesh.triangle_slots.push_back(slot);
  }
}

Status name_slots(Mesh& mesh, const std::string& what) {
  std::uint32_t most = 0;
  for (const std::uint32_t slot : mesh.triangle_slots) most = std::max(most, slot);
  constexpr std::uint32_t kMostSlots = 1u << 15;
  if (most >= kMostSlots) {
    return fail(ErrorKind::kCorrupt, "{}: slot {} is more than {}", what, most, kMostSlots);
  }
  for (std::uint32_t slot = 0; slot <= most; ++slot) {
    mesh.slot_names.push_back(fmt::format("slot{}", slot));
  }
  return {};
}

}  // namespace

Result<std::string> encode_draco(const Mesh& mesh, const DracoOptions& options) {
  if (Status status = check_mesh(mesh, "the mesh to compress"); !status)
    return forward_error(status);
  const Points points = collect_points(mesh);
  draco::Mesh out;
  out.set_num_points(static_cast<std::uint32_t>(points.keys.size()));
  const int positions = add_attribute(out, GeometryAttribute::POSITION, draco::DT_FLOAT32,
                                      mesh.positions, points.keys, 0);
  const int uvs = add_attribute(out, GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, points.uvs,
                                points.keys, 1);
  if (mesh.slot_names.size() > 1) {
    add_attribute(out, kSlotAttribute, draco::DT_UINT32, points.slots, points.keys, 2);
  }
  for (const auto& face : points.faces) out.AddFace(face);

  draco::ExpertEncoder encoder(out);
  encoder.SetAttributeQuantization(positions, options.position_bits);
  encoder.SetAttributeQuantization(uvs, options.uv_bits);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  // The scheme that Draco would choose reads an unchecked count: seconds for one damaged byte.
  if (!encoder.SetAttributePredictionScheme(uvs, draco::MESH_PREDICTION_PARALLELOGRAM).ok()) {
    return fail(ErrorKind::kInput, "Draco cannot predict the UVs of the mesh");
  }
  // Above speed 5 Draco splits the mesh at UV seams, and vertices would no longer be shared.
  encoder.SetSpeedOptions(3, 3);
  draco::EncoderBuffer buffer;
  try {
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (status.ok()) return std::string(buffer.data(), buffer.size());
    return fail(ErrorKind::kInput, "Draco cannot compress the mesh: {}", status.error_msg_string());
  } catch (const std::exception& error) {
    return fail(ErrorKind::kInput, "Draco cannot compress the mesh: {}", error.what());
  }
}

Result<Mesh> decode_draco(std::string_view bytes, const std::string& what) {
  auto decoded = decode(bytes, what);
  if (!decoded) return forward_error(decoded);
  const draco::Mesh& in = **decoded;
  if (Status status = check_attributes(in, what); !status) return forward_error(status);
  if (Status status = check_faces(in, what); !status) return forward_error(status);
  Mesh mesh;
  const auto& positions = *in.GetNamedAttribute(GeometryAttribute::POSITION);
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    mesh.positions.push_back(positions.GetValue<float, 3>(AttributeValueIndex(i)));
  }
  copy_triangles(in, mesh);
  if (Status status = name_slots(mesh, what); !status) return forward_error(status);
  if (Status status = check_mesh(mesh, what); !status) {
    return fail(ErrorKind::kCorrupt, "{}", status.error().message);
  }
  return mesh;
}

}  // namespace seedframe
