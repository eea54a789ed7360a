// Layers of low resolution cut into runs by those of full resolution between them: glass that stands in smoke has the
// smoke before it over it, and the rest behind. For compositing that sorts.
#pragma once
#include <memory>
#include <span>

#include "composite/low_shares.h"
#include "composite/low_surface.h"

namespace pellucid {

struct DeepOpaque;

// What may stand between the layers besides those of full resolution.
struct LowBetween {
  bool fog = false;                  // runs are cut where the layers are far apart
  const DeepOpaque* deep = nullptr;  // at the samples of a deep picture; null for a flat one
};

class LowRuns {
 public:
  LowRuns(std::shared_ptr<const LowView> view, glm::dvec2 sample, const LowBetween& others = {});
  // Lists of texels from near to far, each texel once.
  void add(const FragmentLists& texels);
  // After all of them, before between().
  void finish();

  // Adds the depths at which what else stands there cuts the pixel's runs, in any order.
  void addCuts(int x, int y, std::vector<float>& depths) const;
  // Appends the runs of a pixel, a fragment each: what lies before the first depth, between the first two, and on.
  // Texels are mixed run by run, each seen through what its own texel has before it, so that all runs of a pixel
  // together are what one layer would be.
  //   x, y    of the data window
  //   depths  of the pixel's layers, rising, planar metres
  void between(int x, int y, std::span<const float> depths, std::uint32_t identity, std::vector<Fragment>& runs) const;

 private:
  struct TexelLayer {
    glm::vec3 light, transmission;
    float z;
  };
  struct Run;
  void addGaps(int x, int y, std::vector<float>& depths) const;
  void addTexel(const LowSurface::Pixel& pixel, int i, int j, double share, std::span<const float> depths,
                std::vector<Run>& runs) const;

  std::shared_ptr<const LowView> view_;
  glm::dvec2 sample_;
  LowBetween others_;
  Image<std::vector<TexelLayer>> layers_;
  Image<shading::LowTexel> texels_;
  LowShares shares_;
  std::unique_ptr<LowSurface> surface_;
};

}  // namespace pellucid
