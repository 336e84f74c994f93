// Which kind of image a file is: its name says so, and its content is held to it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace seedframe {

enum class ImageKind { kPng, kJpeg, kTiff, kExr, kHdr, kWebp, kTga, kBmp };

/// By the ending alone, whatever its case: .png; .jpg, .jpeg; .tif, .tiff; .exr; .hdr; .webp; .tga;
/// .bmp.
std::optional<ImageKind> image_kind_of(const std::filesystem::path& file);

/// "PNG", "JPEG", …
const char* name_of(ImageKind kind);

/// All endings, for messages: ".png, .jpg, …".
std::string image_endings();

/// What the first bytes of a file look like, for a message: "an HTML page", "a Git LFS pointer", "a
/// JPEG", "empty"; nothing when they look like nothing in particular.
std::string what_bytes_look_like(std::string_view bytes);

/// Whether the first bytes are those of the kind. A TGA has none of its own.
bool begins_like(std::string_view bytes, ImageKind kind);

}  // namespace seedframe
