// Deep EXR, scanlines or tiles, a band of rows at a time: samples as stored, in any order, as floats.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gbuffer/camera.h"
#include "gbuffer/image.h"

namespace pellucid {

// Samples of whole rows, pixel by pixel.
struct DeepRows {
  Window window;                             // the rows, as wide as the data window
  std::vector<std::uint64_t> offsets;        // width * height + 1: pixel i owns samples [offsets[i], offsets[i + 1])
  std::vector<std::vector<float>> channels;  // one entry a sample, in the order of the channels asked for
};

class DeepReader {
 public:
  // Opens the part and reads the named channels only; half and uint are converted to float. Throws InputError for what
  // is missing, damaged or not deep, MeaningError for a channel that is not there.
  DeepReader(const std::string& path, int part, const std::vector<std::string>& channels);
  ~DeepReader();

  const Window& data() const;
  const Window& display() const;
  // Rows y0 <= y < y1 (display coordinates, inside the data window), or fewer of them, but one at least, so that at
  // most `most` samples are held (of tiled files a row of tiles besides). Throws InputError for damage, ResourceError
  // when memory runs out.
  //   reused  rows that are done with, whose memory is taken
  DeepRows read(int y0, int y1, std::uint64_t most = UINT64_MAX, DeepRows reused = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct DeepHeader {
  Window display, data;
  double pixelAspect = 1.0;
  std::vector<std::string> channels;  // all float
  std::map<std::string, std::string> attributes;
  const Camera* camera = nullptr;     // written when given
  std::vector<float> chromaticities;  // 8 numbers, or none
};

// A new single-part deep scanline file, ZIPS. Rows come from the top, without gaps; the file appears at finish().
class DeepWriter {
 public:
  DeepWriter(const std::string& path, const DeepHeader& header);  // throws ResourceError
  ~DeepWriter();
  void write(const DeepRows& rows);
  void finish();  // std::logic_error unless every row was written

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid
