// measure_deep_file OUT.exr WIDTH HEIGHT SAMPLES SEED: a deep scanline EXR as renderers write them, half R G B A and
// float Z, ZIPS, with SAMPLES thin samples in every pixel, in no order of depth. What flatten_table.sh times.
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfHeader.h>

#include <half.h>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/random.h"

namespace {

using pellucid::test::Random;

void writeDeep(const std::string& path, int width, int height, int samples, std::uint64_t seed) {
  Imf::Header header(width, height);
  header.compression() = Imf::ZIPS_COMPRESSION;
  header.setType("deepscanline");
  const char* names[] = {"R", "G", "B", "A"};
  for (const char* name : names) header.channels().insert(name, Imf::Channel(Imf::HALF));
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));

  const auto columns = static_cast<std::size_t>(width), count = columns * static_cast<std::size_t>(samples);
  const std::vector<unsigned> counts(columns, static_cast<unsigned>(samples));
  std::vector<half> colours[4];
  std::vector<half*> colourAt[4];
  std::vector<float> depths(count);
  std::vector<float*> depthAt;
  for (std::size_t c = 0; c < 4; ++c) colours[c].resize(count);
  for (std::size_t x = 0; x < columns; ++x) {
    for (std::size_t c = 0; c < 4; ++c) colourAt[c].push_back(&colours[c][x * static_cast<std::size_t>(samples)]);
    depthAt.push_back(&depths[x * static_cast<std::size_t>(samples)]);
  }
  // One row for all: no stride in y.
  Imf::DeepFrameBuffer frame;
  const auto base = [](const auto* values) { return const_cast<char*>(reinterpret_cast<const char*>(values)); };
  frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, base(counts.data()), sizeof(unsigned), 0));
  for (std::size_t c = 0; c < 4; ++c)
    frame.insert(names[c], Imf::DeepSlice(Imf::HALF, base(colourAt[c].data()), sizeof(half*), 0, sizeof(half)));
  frame.insert("Z", Imf::DeepSlice(Imf::FLOAT, base(depthAt.data()), sizeof(float*), 0, sizeof(float)));

  Imf::DeepScanLineOutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  Random random(seed);
  for (int y = 0; y < height; ++y) {
    for (std::size_t i = 0; i < count; ++i) {
      const float alpha = 0.02f + 0.3f * random.uniformf();
      for (std::size_t c = 0; c < 3; ++c) colours[c][i] = half(alpha * random.uniformf());
      colours[3][i] = half(alpha);
      depths[i] = 1.0f + 99.0f * random.uniformf();
    }
    file.writePixels(1);
  }
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count != 6) throw std::runtime_error("expected OUT.exr WIDTH HEIGHT SAMPLES SEED");
    const int width = std::atoi(arguments[2]), height = std::atoi(arguments[3]), samples = std::atoi(arguments[4]);
    if (width < 1 || height < 1 || samples < 1) throw std::runtime_error("expected sizes from 1");
    writeDeep(arguments[1], width, height, samples, static_cast<std::uint64_t>(std::atoll(arguments[5])));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "measure_deep_file: %s\n", error.what());
    return 1;
  }
}
