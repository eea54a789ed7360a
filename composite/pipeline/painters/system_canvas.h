// Where the veils of coarsely sorted systems meet: in the pixels of a flat picture, or in the places of a deep one,
// each of whose samples holds layers out on its own.
#pragma once
#include <functional>

#include "composite/deep/deep_opaque.h"
#include "composite/gather.h"
#include "composite/pipeline/lighting.h"
#include "composite/veil.h"

namespace pellucid {

class SystemCanvas {
 public:
  // Composites lists to a veil; both of the window.
  using Mix = std::function<void(const FragmentLists& lists, const Window& window, Veil& veil)>;

  //   picture  outlives this
  explicit SystemCanvas(const LitPicture& picture);

  // A veil in which nothing is.
  Veil empty() const;
  // Mixes what layers of a window of the picture show, into a veil of empty().
  void mix(const FragmentLists& lists, const Mix& mix, Veil& veil);
  // Puts solids behind all systems; where layers scatter, these look them up.
  //   planes  of the whole scene
  void addSolids(const OitPlanes& planes, Veil& veil) const;
  // The veil of the picture, with what its layers look up.
  Veil finish(const OitPlanes& planes, const LookupSettings& lookup, Veil veil) const;

 private:
  const GBuffer &gbuffer_, &centres_;
  const EdgeTexels* edges_;
  const DeepOpaque* deep_;
  HeldOutRow places_;  // of a deep picture: all of its places
};

}  // namespace pellucid
