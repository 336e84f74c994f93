#include <memory>
#include <string_view>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "image_files/plugin/calls.h"

namespace seedframe::image_module {
namespace {

/// Exif's own way of saying that the time is unknown; without one, the TIFF writer asks the clock.
constexpr const char* kNoDate = "    :  :     :  :  ";

OIIO::ImageSpec spec_of(const WriteRequest& request) {
  OIIO::ImageSpec spec(request.width, request.height, 3, OIIO::TypeUInt8);
  // No more than a writer needs: what it has no place for, it writes as text, and of a colour space
  // the TIFF writer makes an Exif directory that it does not finish in memory.
  const std::string_view writer = request.writer;
  if (writer == "tiff") spec.attribute("DateTime", kNoDate);
  if (writer == "jpeg") spec.attribute("jpeg:subsampling", "4:4:4");
  if (request.compression[0] != '\0') spec.attribute("compression", request.compression);
  return spec;
}

}  // namespace

bool write_image(const WriteRequest* request, const ByteSink* sink, Fault* fault) {
  return guarded(fault, [&] {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(request->writer);
    if (output == nullptr) {
      (void)OIIO::geterror();
      return refuse(fault, std::string("this OpenImageIO has no writer for ") + request->writer);
    }
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    output->threads(1);
    output->set_ioproxy(&memory);
    const std::string name = std::string("image.") + request->writer;
    const bool done = output->open(name, spec_of(*request)) &&
                      output->write_image(OIIO::TypeUInt8, request->rgb) && output->close();
    const std::string reason = output->geterror();
    if (!done) return refuse(fault, reason.empty() ? "the writer gives no reason" : reason);
    sink->bytes(sink->self, bytes.data(), bytes.size());
    return true;
  });
}

}  // namespace seedframe::image_module
