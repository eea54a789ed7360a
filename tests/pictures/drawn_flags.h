// Random flags of `composite` under which the right picture is known.
#pragma once
#include <string>
#include <vector>

#include "tests/pictures/scene_files.h"

namespace pellucid::test {

struct DrawnFlags {
  std::vector<std::string> words;  // as on the command line, files apart
  int passes = 8;
  reference::PixelWeights filter;
  OpaqueForm form;
  bool edges = true;     // filtered edges are taken apart
  bool softMask = true;  // rims of masks are as wide as a sample
  std::string method = "over";
  // Largest relative step of the depth that the file holds, as gbuffer/README.md states it.
  double depthStep() const { return form.half ? 0x1p-10 : 0x1p-20; }
};

DrawnFlags drawFlags(const DrawnScene& scene, Random& random);

}  // namespace pellucid::test
