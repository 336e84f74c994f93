#include "mesh_files/draco_header.h"

#include <cstdint>
#include <optional>

namespace seedframe {
namespace {

/// Seven bits a byte, the lowest first; the last byte is below 128.
std::optional<std::uint64_t> take_varint(std::string_view& bytes) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 35 && !bytes.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    value |= std::uint64_t{byte & 0x7fu} << shift;
    if (byte < 0x80u) return value;
  }
  return std::nullopt;
}

}  // namespace

// "Draco Bitstream Specification" 2.2 (google.github.io/draco/spec): ParseHeader,
// ParseEdgebreakerConnectivityData.
const char* draco_header_fault(std::string_view bytes) {
  using namespace std::string_view_literals;
  constexpr auto kHeader = "DRACO\x02\x02\x01\x01\x00\x00"sv;  // 2.2, mesh, edgebreaker, no flags
  if (!bytes.starts_with(kHeader)) return "it is not of bitstream 2.2 and edgebreaker";
  std::string_view rest = bytes.substr(kHeader.size());
  if (rest.empty()) return "it ends in its header";
  rest.remove_prefix(1);  // how the triangles are walked
  const auto vertices = take_varint(rest);
  const auto triangles = take_varint(rest);
  if (!vertices || !triangles) return "it ends in its header";
  // A flat grid, the most regular of meshes, has 16 triangles a byte.
  constexpr std::uint64_t kMostPerByte = 256;
  const std::uint64_t most = kMostPerByte * bytes.size();
  if (*vertices > most || *triangles > most) return "it claims more triangles than it could hold";
  return nullptr;
}

}  // namespace seedframe
