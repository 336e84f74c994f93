// The container of glTF 2.0: JSON, buffers and the numbers in them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"

namespace seedframe {

/// A .gltf or .glb file with its buffers in memory. Errors (kInput) name the file and the place in
/// its JSON.
class GltfFile {
 public:
  /// Buffers are in the file itself, or files in its folder or below it; nothing else is opened.
  static Result<GltfFile> open(const std::filesystem::path& path);

  const Json& json() const { return *json_; }
  const std::string& name() const { return name_; }

  /// json()[list][index]; an error if there is none.
  Result<const Json*> entry(const char* list, std::uint64_t index) const;

  /// The elements of an accessor, row by row, `components` numbers each; normalised integers as
  /// fractions. Their bytes are in the file, so that memory stays within a few times its size.
  struct Numbers {
    std::uint64_t count = 0;
    std::vector<double> values;
  };
  Result<Numbers> read_accessor(std::uint64_t index, std::uint64_t components) const;

  /// The bytes of images[index], which are in the file, or in one of its folder or below it.
  Result<std::string> read_image(std::uint64_t index) const;

  template <class... Args>
  tl::unexpected<Error> fail_at(const std::string& place, fmt::format_string<Args...> format,
                                Args&&... args) const {
    return fail(ErrorKind::kInput, "{}{}{}: {}", name_, place.empty() ? "" : ": ", place,
                fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  Status split_container(std::string_view bytes);
  Status check_head() const;
  Status load_buffers();
  Result<std::string> load_buffer(const Json& buffer, bool first, const std::string& place) const;
  Result<std::string> load_uri(const std::string& uri, std::uintmax_t most,
                               const std::string& place) const;
  Result<std::string_view> view_bytes(std::uint64_t index, std::uint64_t& stride) const;

  std::string name_;
  std::filesystem::path folder_;
  std::unique_ptr<const Json> json_;
  std::string chunk_;  ///< the binary chunk of a .glb
  bool has_chunk_ = false;
  std::vector<std::string> buffers_;
};

/// object[key] as a whole number from 0 to 2^53; `missing` if it is absent, nothing if it is
/// something else.
std::optional<std::uint64_t> gltf_index(const Json& object, const char* key,
                                        std::optional<std::uint64_t> missing = std::nullopt);

}  // namespace seedframe
