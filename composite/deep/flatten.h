// A deep file to a flat picture, exactly: any order, overlapping volumes, coincident samples, coloured opacity.
// Streamed by bands of scanlines, so that memory does not follow the file's size.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "composite/deep/sample_channels.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/image.h"

namespace pellucid {

struct FlatPicture {
  Window display, data;
  Image<glm::vec3> light;    // premultiplied, scene-linear
  Image<glm::vec4> opacity;  // per channel, and A
  Image<float> frontZ;       // nearest sample, the file's unit, +inf where there is none
  bool colouredOpacity = false;
  std::uint64_t samples = 0;
  DeepOddities oddities;
  ExrPart like;                    // header of the first file
  std::vector<std::string> notes;  // which parts were taken, where files have several
};

// Merges the files' samples over the union of their data windows and composites them front to back.
//   most  deep samples held at once, beyond one row's
//   view  what --view says
//   told  the share of the rows that are done, as the bands go by; may be null
// Throws what resolveDeep and DeepReader throw, MeaningError for display windows that differ.
FlatPicture flattenDeep(const std::vector<std::string>& paths, std::uint64_t most = std::uint64_t{1} << 21,
                        const std::string& view = "", const std::function<void(double)>& told = nullptr);

}  // namespace pellucid
