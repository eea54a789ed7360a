// A program that uses the C++ libraries from an installed prefix: one fragment over one pixel.
#include <cmath>
#include <cstdio>
#include <limits>

#include "composite/fold.h"
#include "composite/resolve.h"

int main() {
  using namespace pellucid;
  GBuffer picture;
  picture.display = picture.data = {0, 0, 1, 1};
  picture.beauty = Image<glm::vec4>(1, 1, glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));
  picture.viewZ = Image<float>(1, 1, 5.0f);
  FragmentLists lists;
  lists.window = picture.data;
  lists.solid = Image<glm::vec4>(1, 1, glm::vec4(0, 0, 0, std::numeric_limits<float>::infinity()));
  lists.offsets = {0, 1};
  Fragment fragment{};
  fragment.radiance = glm::vec3(0.1f);
  fragment.coverage = 1.0f;
  fragment.transmission = glm::vec3(0.9f, 0.5f, 0.2f);
  fragment.z = 2.0f;
  lists.fragments = {fragment};
  OitPlanes planes = emptyPlanes(picture.display, picture.data);
  foldFragments(lists, planes.info.weight, planes.info.normalisation, planes);
  const glm::vec4 pixel = compose(resolveOver(planes, {}, {}, picture), picture).rgba[0];
  for (int c = 0; c < 3; ++c)
    if (std::abs(pixel[c] - (0.1f + 0.5f * fragment.transmission[c])) > 1e-6f) return 1;
  std::puts("composited");
}
