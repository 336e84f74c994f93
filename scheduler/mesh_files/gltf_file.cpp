// Our own reader on nlohmann/json, because tinygltf 2.7 leaves every range of the accessors to its
// caller, converts numbers that do not fit, and opens whatever files the images name.
#include "mesh_files/gltf_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <openssl/evp.h>

#include "base/allowed_folders.h"
#include "base/files.h"
#include "base/utf8.h"
#include "mesh_files/byte_reader.h"
#include "mesh_files/file_material.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr double kMostExact = 9007199254740992.0;  // 2^53

// Without the '=' at its end too, as browsers take it; otherwise as strict as RFC 4648.
std::optional<std::string> decode_base64(std::string_view text) {
  constexpr std::size_t kPiece = std::size_t{1} << 30;  // OpenSSL counts in int
  const std::size_t digits = text.find_last_not_of('=') + 1;
  std::string padded(text.substr(0, digits));
  if (padded.find('=') != std::string::npos) return std::nullopt;  // OpenSSL would take it
  padded.resize((digits + 3) / 4 * 4, '=');
  std::string bytes(padded.size() / 4 * 3, '\0');
  for (std::size_t at = 0; at < padded.size(); at += kPiece) {
    const std::size_t size = std::min(kPiece, padded.size() - at);
    const int decoded = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()) + at / 4 * 3,
                                        reinterpret_cast<const unsigned char*>(padded.data()) + at,
                                        static_cast<int>(size));
    if (decoded != static_cast<int>(size / 4 * 3)) return std::nullopt;  // spaces give fewer
  }
  bytes.resize(digits * 3 / 4);
  return bytes;
}

std::string percent_decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned char code = 0;
    const char* digits = uri.data() + i + 1;
    const bool escape = uri[i] == '%' && i + 2 < uri.size() &&
                        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    text.push_back(escape ? static_cast<char>(code) : uri[i]);
    if (escape) i += 2;
  }
  return text;
}

struct ComponentType {
  std::uint64_t bytes = 0;
  double scale = 1.0;  // of a normalised integer
  double (*read)(std::string_view) = nullptr;
};

template <class T>
double read_as_double(std::string_view bytes) {
  return static_cast<double>(value_from<T>(bytes));
}

std::optional<ComponentType> component_type(std::uint64_t code) {
  switch (code) {
    case 5120:
      return ComponentType{1, 1.0 / 127.0, read_as_double<std::int8_t>};
    case 5121:
      return ComponentType{1, 1.0 / 255.0, read_as_double<std::uint8_t>};
    case 5122:
      return ComponentType{2, 1.0 / 32767.0, read_as_double<std::int16_t>};
    case 5123:
      return ComponentType{2, 1.0 / 65535.0, read_as_double<std::uint16_t>};
    case 5125:
      return ComponentType{4, 1.0, read_as_double<std::uint32_t>};
    case 5126:
      return ComponentType{4, 1.0, read_as_double<float>};
    default:
      return std::nullopt;
  }
}

// Of any vendor: what materials, textures and lights look like does not matter to a mesh.
bool is_harmless_extension(std::string_view name) {
  if (name == "KHR_mesh_quantization") return true;
  const std::size_t vendor = name.find('_');
  if (vendor == std::string_view::npos) return false;
  const std::string_view kind = name.substr(vendor + 1);
  constexpr std::string_view kKinds[] = {"materials", "texture", "lights", "animation",
                                         "audio",     "xmp",     "image"};
  return std::any_of(std::begin(kKinds), std::end(kKinds),
                     [kind](std::string_view harmless) { return kind.starts_with(harmless); });
}

std::string_view type_name(std::uint64_t components) {
  return components == 1 ? "SCALAR" : components == 2 ? "VEC2" : components == 3 ? "VEC3" : "VEC4";
}

}  // namespace

std::optional<std::uint64_t> gltf_index(const Json& object, const char* key,
                                        std::optional<std::uint64_t> missing) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  if (found == object.end()) return missing;
  if (!found->is_number()) return std::nullopt;
  const auto number = found->get<double>();
  if (!(number >= 0.0 && number <= kMostExact) || number != std::floor(number)) return std::nullopt;
  return static_cast<std::uint64_t>(number);
}

Result<GltfFile> GltfFile::open(const fs::path& path) {
  GltfFile file;
  file.name_ = path.string();
  file.folder_ = path.parent_path();
  const auto bytes = read_file(path);
  if (!bytes) return forward_error(bytes);
  if (Status status = file.split_container(*bytes); !status) return forward_error(status);
  if (Status status = file.check_head(); !status) return forward_error(status);
  if (Status status = file.load_buffers(); !status) return forward_error(status);
  return file;
}

// A .glb is a header, a chunk of JSON and perhaps a chunk of bytes; a .gltf is the JSON alone.
Status GltfFile::split_container(std::string_view bytes) {
  std::string_view text = bytes;
  if (bytes.starts_with("glTF")) {
    std::string_view rest = bytes.substr(4);
    const auto version = take_value<std::uint32_t>(rest);
    const auto length = take_value<std::uint32_t>(rest);
    const auto json_length = take_value<std::uint32_t>(rest);
    const auto json_type = take_value<std::uint32_t>(rest);
    if (!json_type || *version != 2) return fail_at("", "expected a binary glTF of version 2");
    constexpr std::uint32_t kJson = 0x4e4f534a;
    constexpr std::uint32_t kBin = 0x004e4942;
    if (*length != bytes.size() || *json_type != kJson || *json_length > rest.size()) {
      return fail_at("", "the file is cut short or damaged: its header says {} bytes, there are {}",
                     *length, bytes.size());
    }
    text = rest.substr(0, *json_length);
    rest.remove_prefix(*json_length);
    const auto chunk_length = take_value<std::uint32_t>(rest);
    const auto chunk_type = take_value<std::uint32_t>(rest);
    has_chunk_ = chunk_type && *chunk_type == kBin;
    if (has_chunk_ && *chunk_length > rest.size()) {
      return fail_at("", "the file is damaged: its binary chunk says {} bytes, {} are left",
                     *chunk_length, rest.size());
    }
    if (has_chunk_) chunk_ = rest.substr(0, *chunk_length);
  }
  // In Latin-1, by the standard never, a name is no reason to refuse a mesh.
  auto json = is_utf8(text) ? parse_json(text, name_) : parse_json(as_utf8(text), name_);
  if (!json) return fail(ErrorKind::kInput, "{}", json.error().message);
  json_ = std::make_unique<const Json>(std::move(*json));
  return {};
}

Status GltfFile::check_head() const {
  const Json* asset =
      json_->is_object() && json_->contains("asset") ? &json_->at("asset") : nullptr;
  const Json version =
      asset != nullptr && asset->is_object() ? asset->value("version", Json()) : Json();
  if (!version.is_string() || !version.get<std::string>().starts_with("2.")) {
    return fail_at("asset.version", "expected glTF 2.0, found {}", version.dump(-1, ' ', true));
  }
  const Json required = json_->value("extensionsRequired", Json::array());
  for (const Json& extension : required) {
    const std::string needed = extension.is_string() ? extension.get<std::string>() : "";
    if (!is_harmless_extension(needed)) {
      return fail_at("extensionsRequired",
                     "'{}' cannot be read: export the file without compression and extensions",
                     needed);
    }
  }
  return {};
}

Result<const Json*> GltfFile::entry(const char* list, std::uint64_t index) const {
  const auto found = json_->find(list);
  const bool is_list = found != json_->end() && found->is_array();
  if (!is_list || index >= found->size() || !(*found)[index].is_object()) {
    return fail_at("", "there is no {}[{}]: the list has {}", list, index,
                   is_list ? found->size() : 0);
  }
  return &(*found)[index];
}

Status GltfFile::load_buffers() {
  const Json list = json_->value("buffers", Json::array());
  constexpr std::size_t kMostBuffers = 1024;
  if (!list.is_array() || list.size() > kMostBuffers) {
    return fail_at("buffers", "expected a list of at most {}", kMostBuffers);
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    auto bytes = load_buffer(list[i], i == 0, fmt::format("buffers[{}]", i));
    if (!bytes) return forward_error(bytes);
    buffers_.push_back(std::move(*bytes));
  }
  return {};
}

Result<std::string> GltfFile::load_buffer(const Json& buffer, bool first,
                                          const std::string& place) const {
  const auto length = gltf_index(buffer, "byteLength");
  if (!length) return fail_at(place, "byteLength is missing or not a whole number");
  const Json uri = buffer.value("uri", Json());
  std::string bytes;
  if (uri.is_null() && first && has_chunk_) {
    bytes = chunk_;
  } else if (!uri.is_string()) {
    return fail_at(place, "there are no bytes for it: expected a 'uri' or a binary chunk");
  } else {
    auto loaded = load_uri(uri.get<std::string>(), kLargestFile, place);
    if (!loaded) return loaded;
    bytes = std::move(*loaded);
  }
  if (bytes.size() < *length) {
    return fail_at(place, "cut short: {} bytes promised, {} found", *length, bytes.size());
  }
  bytes.resize(*length);
  return bytes;
}

Result<std::string> GltfFile::load_uri(const std::string& uri, std::uintmax_t most,
                                       const std::string& place) const {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(";base64,");
    auto decoded = comma == std::string::npos
                       ? std::nullopt
                       : decode_base64(std::string_view(uri).substr(comma + 8));
    if (!decoded) return fail_at(place, "expected data in base64");
    return std::move(*decoded);
  }
  const fs::path relative = percent_decoded(uri);
  const fs::path path = folder_ / relative;
  if (relative.empty() || relative.is_absolute() || uri.find(':') != std::string::npos ||
      uri.find('\0') != std::string::npos || !AllowedFolders({folder_}).check(path, uri)) {
    return fail_at(place, "'{}' is not a file in the folder of the glTF file", uri.substr(0, 200));
  }
  auto read = read_file(path, most);
  if (!read) return fail(ErrorKind::kInput, "{}: {}: {}", name_, place, read.error().message);
  return read;
}

Result<std::string> GltfFile::read_image(std::uint64_t index) const {
  const auto image = entry("images", index);
  if (!image) return forward_error(image);
  const std::string place = fmt::format("images[{}]", index);
  if (const auto view = gltf_index(**image, "bufferView")) {
    std::uint64_t stride = 0;
    const auto bytes = view_bytes(*view, stride);
    if (!bytes) return forward_error(bytes);
    return std::string(*bytes);
  }
  const Json uri = (*image)->value("uri", Json());
  if (!uri.is_string()) return fail_at(place, "expected a 'uri' or a 'bufferView'");
  return load_uri(uri.get<std::string>(), kMostImageBytes, place);
}

// The bytes of bufferViews[index]; `stride` is left alone where it has none.
Result<std::string_view> GltfFile::view_bytes(std::uint64_t index, std::uint64_t& stride) const {
  const std::string place = fmt::format("bufferViews[{}]", index);
  const auto view = entry("bufferViews", index);
  if (!view) return forward_error(view);
  const auto buffer = gltf_index(**view, "buffer");
  const auto offset = gltf_index(**view, "byteOffset", 0);
  const auto length = gltf_index(**view, "byteLength");
  const auto own_stride = gltf_index(**view, "byteStride", stride);
  if (!buffer || *buffer >= buffers_.size() || !offset || !length || !own_stride) {
    return fail_at(place, "expected buffer, byteOffset and byteLength of {} buffers",
                   buffers_.size());
  }
  const std::string_view bytes = buffers_[*buffer];
  if (*offset > bytes.size() || *length > bytes.size() - *offset) {
    return fail_at(place, "{} bytes from byte {} on end beyond the buffer's {}", *length, *offset,
                   bytes.size());
  }
  stride = *own_stride;
  return bytes.substr(*offset, *length);
}

Result<GltfFile::Numbers> GltfFile::read_accessor(std::uint64_t index,
                                                  std::uint64_t components) const {
  const std::string place = fmt::format("accessors[{}]", index);
  const auto found = entry("accessors", index);
  if (!found) return forward_error(found);
  const Json& accessor = **found;
  const auto count = gltf_index(accessor, "count");
  const auto offset = gltf_index(accessor, "byteOffset", 0);
  const auto view = gltf_index(accessor, "bufferView");
  const auto type = component_type(gltf_index(accessor, "componentType").value_or(0));
  if (!count || !offset || !type || accessor.value("type", Json()) != type_name(components)) {
    return fail_at(place, "expected count, componentType and the type {}", type_name(components));
  }
  if (!view || accessor.contains("sparse")) {
    return fail_at(place, "accessors that are sparse or have no bufferView cannot be read");
  }
  const std::uint64_t size = type->bytes * components;
  std::uint64_t stride = size;
  const auto bytes = view_bytes(*view, stride);
  if (!bytes) return forward_error(bytes);
  // Without sums or products that might overflow.
  const bool fits = stride >= size && stride <= 65536 && *offset <= bytes->size() &&
                    (*count == 0 || (size <= bytes->size() - *offset &&
                                     *count - 1 <= (bytes->size() - *offset - size) / stride));
  if (!fits) {
    return fail_at(place, "{} elements of {} bytes, one every {}, end beyond the view's {} bytes",
                   *count, size, stride, bytes->size());
  }
  const Json flag = accessor.value("normalized", Json(false));
  const bool normalized = flag.is_boolean() && flag.get<bool>();
  Numbers numbers{.count = *count, .values = {}};
  numbers.values.reserve(*count * components);
  for (std::uint64_t i = 0; i < *count; ++i) {
    const std::string_view element = bytes->substr(*offset + i * stride, size);
    for (std::uint64_t c = 0; c < components; ++c) {
      const double value = type->read(element.substr(c * type->bytes));
      numbers.values.push_back(normalized ? std::max(-1.0, value * type->scale) : value);
    }
  }
  return numbers;
}

}  // namespace seedframe
