#include "image/exr_metadata.h"

#include <exception>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include "base/files.h"
#include "image/exr_memory.h"

namespace seedframe {

Status copy_without_metadata(const std::filesystem::path& from, const std::filesystem::path& to) {
  ExrMemoryOutput output;
  try {
    Imf::InputFile input(from.c_str(), /*numThreads=*/0);
    const Imf::Header& original = input.header();
    Imf::Header header(original.displayWindow(), original.dataWindow(), original.pixelAspectRatio(),
                       original.screenWindowCenter(), original.screenWindowWidth(),
                       original.lineOrder(), original.compression());
    header.channels() = original.channels();
    Imf::OutputFile copy(output, header, /*numThreads=*/0);
    copy.copyPixels(input);
  } catch (const std::exception& error) {
    return fail(ErrorKind::kRender, "cannot copy the passes {}: {}", from.string(), error.what());
  }
  return write_file_unsynced(to, output.bytes());
}

}  // namespace seedframe
