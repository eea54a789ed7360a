// The opaque picture as one jittered pass sees it.
#pragma once
#include <optional>

#include "composite/deep/sample_planes.h"
#include "composite/edges.h"
#include "composite/pipeline/lighting.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "gbuffer/depth_plane.h"

namespace pellucid {

// The picture whose depth moves with the passes: whatever reads it, layers, fog, low resolution or samples, meets the
// opaque surface where the pass samples the pixel, and needs to know nothing of it. Of a deep picture all samples move.
// Where a pass samples pixel centres it is the picture itself.
class PassPicture {
 public:
  // The others must outlive this.
  //   planes     of the picture's depth; null leaves it as it is
  //   edges      pixels of two surfaces, of which a pass sees one; null: none
  //   triangles  drawn over this picture while it lives; null: none
  //   camera     when this is made, the one that took the picture; at each moveTo(), the one that the pass sees through
  //   area       of which the passes are, display coordinates: depth moves there alone
  PassPicture(const LitPicture& centres, const DepthPlanes* planes, const EdgePasses* edges, TransparentPass* triangles,
              const Camera& camera, const Window& area);
  ~PassPicture();
  PassPicture(const PassPicture&) = delete;
  PassPicture& operator=(const PassPicture&) = delete;

  //   lit  the picture as the pass's light has it, which stays until the next moveTo(); null: as the first one
  void moveTo(glm::dvec2 sample, int pass, const LitPicture* lit = nullptr);
  // From now on, counts the passes in which a pixel's depth is none that the picture shows.
  void countUnseen() { unseen_ = Image<int>(centres_.gbuffer->data.width(), centres_.gbuffer->data.height(), 0); }
  // Their share of the passes that were counted, [0,1]: 0 where every pass sees the picture from where it was taken.
  Image<float> unseenShare() const;
  // Of the pass that it was moved to; always the same object.
  const LitPicture& picture() const { return picture_; }

 private:
  void moveDepth(glm::dvec2 sample);

  const LitPicture& centres_;
  const DepthPlanes* planes_;
  const EdgePasses* edges_;
  TransparentPass* triangles_;
  const Camera taken_;
  const Camera& camera_;
  Window part_;                               // in pixels of the data window
  GBuffer moved_;                             // depth, and what says how to read it
  std::optional<SamplePlanes> samplePlanes_;  // of a deep picture
  DeepOpaque movedDeep_;
  Image<float> passWeight_;
  EdgeTexels edgeTexels_;
  Image<int> unseen_;  // passes; empty while nobody asks
  int counted_ = 0;
  LitPicture picture_;
};

}  // namespace pellucid
