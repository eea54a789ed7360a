// Between OpenEXR and the records: for the files of this room that code EXR.
#pragma once
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>

#include "gbuffer/exr_document.h"

namespace pellucid {

namespace exr = OPENEXR_IMF_NAMESPACE;

struct ExrPart::Header {
  exr::Header header;
  bool hadType = true;  // a single-part file may have none, and OpenEXR adds one
};

inline Window windowOf(const IMATH_NAMESPACE::Box2i& box) {
  return {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1};
}
inline IMATH_NAMESPACE::Box2i boxOf(const Window& window) {
  return {{window.x0, window.y0}, {window.x1 - 1, window.y1 - 1}};
}
inline exr::PixelType exrType(PixelType type) {
  return type == PixelType::uint32 ? exr::UINT : type == PixelType::half ? exr::HALF : exr::FLOAT;
}

// Threads to code with: setExrThreads' when it was called, else every core.
int exrThreads();

// Adds a channel of the data window to what OpenEXR reads into or writes from. OpenEXR does not say const.
void insertSlice(exr::FrameBuffer& frame, const std::string& name, PixelType type, const std::byte* bytes,
                 const Window& data);

}  // namespace pellucid
