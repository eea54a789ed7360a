#include "gbuffer/image_codec.h"

#include "gbuffer/loaded_part.h"

namespace pellucid {

const ImageCodec& imageCodec() {
  static const ImageCodec& codec = *partFunction<const ImageCodec*()>("pellucid_images.so", "pellucidImageCodec")();
  return codec;
}

}  // namespace pellucid
