#include "image/exr_metadata.h"

#include <exception>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include "image/exr_input.h"
#include "image/exr_memory.h"

namespace seedframe {

Result<std::string> without_metadata(std::string_view bytes, const std::string& what) {
  const auto failed = [&](const std::string& why) {
    return fail(ErrorKind::kRender, "cannot copy the passes {}: {}", what, why);
  };
  if (const char* fault = exr_header_fault(bytes)) return failed(fault);
  ExrMemoryOutput output;
  try {
    ExrMemoryInput stream(bytes, what);
    Imf::MultiPartInputFile file(stream, /*numThreads=*/0, /*reconstructChunkOffsetTable=*/false);
    const Imf::Header& original = file.header(0);
    if (const char* fault = exr_size_fault(original, bytes.size())) return failed(fault);
    Imf::Header header(original.displayWindow(), original.dataWindow(), original.pixelAspectRatio(),
                       original.screenWindowCenter(), original.screenWindowWidth(),
                       original.lineOrder(), original.compression());
    header.channels() = original.channels();
    Imf::OutputFile copy(output, header, /*numThreads=*/0);
    Imf::InputPart input(file, 0);
    copy.copyPixels(input);
  } catch (const std::exception& error) {
    return failed(error.what());
  }
  return std::move(output).bytes();
}

}  // namespace seedframe
