// Which objects each pixel of a picture shows, and how much of it: Cryptomatte, as renderers write it (Friedman and
// Jones, "Fully automatic ID mattes with support for motion blur and transparency", 2015; specification 1.2).
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gbuffer/channels.h"
#include "gbuffer/image.h"

namespace pellucid {

constexpr std::uint32_t kNoObject = 0;

class ObjectCoverage {
 public:
  // Of the layer that tells objects apart, or else of the first that the headers name; null where a file has none,
  // where its channels are not there or no 32-bit floats, or where no pixel shows more than one object: that of pixels'
  // centres tells nothing of their edges.
  //   data  the picture's
  static std::shared_ptr<const ObjectCoverage> of(const ExrDocument& document,
                                                  const std::vector<NamedChannel>& channels, const std::string& view,
                                                  const Window& data);

  const std::string& layer() const { return layer_; }  // "ViewLayer.CryptoObject"
  // What most of a pixel shows, kNoObject where that is nothing. Pixels count from the top left of the data window.
  std::uint32_t mostOf(int x, int y) const { return most_.at(x, y); }
  // The part of the pixel that shows any of these, [0,1].
  double coverage(int x, int y, const std::vector<std::uint32_t>& objects) const;

 private:
  struct Part {
    std::size_t pixel;
    std::uint32_t object;
    float coverage;
  };
  explicit ObjectCoverage(const Window& data) : most_(data.width(), data.height(), kNoObject) {}
  void add(const Image<std::uint32_t>& object, const Image<float>& coverage);
  void finish();

  std::string layer_;
  Image<std::uint32_t> most_;
  Image<float> covered_;      // by anything, while it is read
  std::vector<Part> shared_;  // of pixels that show more than one thing, nothing among them; by pixel
};

}  // namespace pellucid
