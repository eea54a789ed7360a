// Layers drawn at a half, a quarter or an eighth of the resolution, and how they enter the sums of full resolution.
// WB13 section 3.4.2, MODEL section 7
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "composite/layer_terms.h"
#include "composite/probe_lists.h"
#include "composite/veil.h"
#include "gbuffer/accum.h"
#include "gbuffer/depth_plane.h"
#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/published.h"
#include "shaders/low_resolution_text.h"

namespace pellucid {

// What a low-resolution pass draws against: texel (i, j) stands for factor x factor pixels of the data window, from
// (factor i, factor j) on; its depth is the farthest opaque one of its pixels. The last texels may reach beyond the
// window.
struct LowView {
  int factor = 1;
  GBuffer gbuffer;  // viewZ alone
  Camera camera;
  Image<float> opaqueZ;                 // of the pixels: what stands behind all layers, planar metres
  const DepthPlanes* planes = nullptr;  // of all pixels, which tell what touches them; null: the depths around do
};

//   solid   nearest fragments that hide everything among the layers of full resolution: rgb, planar z
//   factor  pixels per texel, >= 1
//   planes  LowView::planes
LowView lowViewOf(const GBuffer& gbuffer, const Image<glm::vec4>& solid, const Camera& camera, int factor,
                  const DepthPlanes* planes = nullptr);
//   opaqueZ  LowView::opaqueZ
LowView lowViewOf(const GBuffer& gbuffer, Image<float> opaqueZ, const Camera& camera, int factor,
                  const DepthPlanes* planes);

// What texels become in one pixel: a single layer.
struct UpsampledLayer {
  shading::LowLayer low;
  bool bends = false;      // it refracts or diffuses
  float nearestZ = 0.0f;   // of its layers, planar metres
  ScatterTerms scatter{};  // of planes, float pixels of full resolution
  float refractionZ = 0.0f, diffuseZ = std::numeric_limits<float>::infinity();
  bool isThere() const { return low.shows || bends; }
  const glm::vec4& refraction() const { return scatter.front(); }  // as OitPlanes::refraction holds it
};

// Brings sums of a low view to full resolution, pixel by pixel. Calls `each` for every pixel that holds something, row
// by row in parallel; x and y count from the corner of the data window.
//   low     accumulated over view.gbuffer and view.camera
//   sample  where in pixels and texels both were sampled
void upsample(const OitPlanes& low, const LowView& view, glm::dvec2 sample,
              const std::function<void(int x, int y, const UpsampledLayer& layer)>& each);

// Adds the low-resolution sums to those of full resolution, as one layer per pixel.
//   low     with the weight of `planes`, in float or exact; of the normalisation of `planes` unless they are published
//   clamps  of the published tier; may be null for the others
void addLowResolution(const OitPlanes& low, const LowView& view, glm::dvec2 sample, OitPlanes& planes,
                      PublishedClamps* clamps = nullptr);

// The same for sums of a window of their own, whose pixels lie in `places` of the data window.
void addLowResolution(const OitPlanes& low, const LowView& view, glm::dvec2 sample, const PixelPlaces& places,
                      OitPlanes& planes, PublishedClamps& clamps);

// Sums of layers that are composited already, a layer for each touched pixel, for upsample().
//   veil     of the low view; solids are in it
//   meanZ    planar metres, where touched
//   scatter  what refracts and diffuses in it, or null
OitPlanes planesOfVeil(const Veil& veil, const Image<float>& meanZ, const LowView& view, const OitPlanes* scatter);

class LowRuns;

// The upsampled layers of a picture as fragments, for lists; each pixel's are made when its list asks.
class LowResolutionFragments {
 public:
  //   low     accumulated over view->gbuffer and view->camera
  //   sample  where in pixels and texels both were sampled
  LowResolutionFragments(OitPlanes low, std::shared_ptr<const LowView> view, glm::dvec2 sample, const Window& data);
  // From now on a pixel has them in runs, between its layers, instead of as one. Not where they scatter, which is told
  // of all together.
  void cutByLayers(std::shared_ptr<const LowRuns> runs) { runs_ = std::move(runs); }
  // Adds them to lists of a window inside of the data window; those behind a pixel's solid are left out.
  FragmentLists among(const FragmentLists& lists) const;
  // The same for lists of a window of their own, whose pixels lie in `places`.
  FragmentLists among(const FragmentLists& lists, const PixelPlaces& places) const;
  bool scatters() const { return scatters_; }

 private:
  // What a pixel gets: all its layers as one, or in runs.
  struct Added {
    bool isThere = false;
    Fragment whole;
    ScatterTerms scatter{};      // of its columns
    std::vector<Fragment> runs;  // in its place, unless empty
  };
  struct Source;
  template <class PlaceOf>
  FragmentLists amongThose(const FragmentLists& lists, const PlaceOf& placeOf) const;
  Added addedAt(glm::ivec2 place) const;
  static void append(const Added& added, float solidZ, FragmentLists& one, FragmentLists& lists);
  // Of some pixels of the lists.
  template <class PlaceOf>
  std::vector<Added> addedTo(const FragmentLists& lists, const PlaceOf& placeOf, std::size_t begin,
                             std::size_t end) const;

  Window data_;
  bool scatters_ = false;
  LayerModel layers_;  // theirs, as far as lists have columns for them
  std::shared_ptr<const Source> source_;
  std::shared_ptr<const LowRuns> runs_;
};

}  // namespace pellucid
