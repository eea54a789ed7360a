// EXR files as renderers write them: names of channels and parts, headers, cameras, and what their depth means.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "room.h"

namespace pellucid::test {

using StoredDepth = double (*)(double z, double ray);  // from planar depth and the ray's length over it

struct Layout {
  const char* producer;
  std::string depth;    // the channel that is to be taken
  std::string beauty;   // of the first channel of the picture
  std::string decided;  // the kind that is read; "" where the file is to be refused, with a flag named
  double slack;         // of depth, relative: what its type rounds
  std::vector<Part> parts;
  std::string words;  // of the table: the depth's type, and what tells this file from others of its renderer
};

// Every row of the table of producers, in its order.
std::vector<Layout> layoutsOf(const Room& room);

}  // namespace pellucid::test
