// A picture of N x N samples for each pixel, and the picture of their means that it stands for.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "gbuffer/opaque_io.h"

namespace pellucid {

constexpr int kMostSupersampling = 16;  // N

// Pixels of a window of samples, whose edges lie on edges of pixels.
Window pixelsOf(const Window& samples, int n);
// Throws MeaningError where the picture's windows do not hold whole pixels.
void expectWholePixels(const std::string& path, const GBuffer& samples, int n);

// Each pixel's mean, summed in double precision row by row.
Image<float> meansOf(const Image<float>& samples, int n);
Image<glm::vec4> meansOf(const Image<glm::vec4>& samples, int n);
// Each pixel's sample to the lower right of its middle: of what has no mean, as depths and identities.
Image<float> middlesOf(const Image<float>& samples, int n);
// 1 where any sample has it.
Image<std::uint8_t> anyOf(const Image<std::uint8_t>& samples, int n);
// Means, or middles of channels that hold depths.
ExtraLayer pixelsOf(const ExtraLayer& samples, int n);

// The pixels of a file of samples: the part of its beauty with all of its channels, as scanlines under ZIP, in their
// own types and under the part's header. Depths, identities (whole numbers, Cryptomatte) and what is not finite are
// taken from the middle, all else is the mean; of a deep part only the picture is written. Returns the notes: parts
// that were left out, halves that were clamped. Throws ResourceError.
//   picture, layers  of pixels already
std::vector<std::string> writePixels(const std::string& path, const OpaqueFile& samples, int n,
                                     const Image<glm::vec4>& picture, const std::vector<ExtraLayer>& layers,
                                     const std::map<std::string, std::string>& attributes);

}  // namespace pellucid
