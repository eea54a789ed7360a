// Where the transparent layers of a shot come from. The triangles of the scene are listed first; every other kind joins
// the lists on their way, a file in sources/ for each.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "composite/deep/deep_source.h"
#include "composite/pipeline/lighting.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid {

class LowResolutionFragments;

// Takes lists of windows that together cover the data window, from the top.
using ListSink = std::function<void(const FragmentLists&)>;

// One jittered pass, as sources see it.
struct SourceView {
  const PassSettings& settings;
  LitPicture picture;
  VolumeRule rule = VolumeRule::midDepth;  // how what has a thickness becomes fragments
  // Layers of low resolution, which join behind deep files and cut the fog; null where there are none.
  const LowResolutionFragments* low = nullptr;
};

// Where identities name pieces of triangles and so stand for the pixel, too (PassSettings::pieces), those of layers
// that are no triangles get it mixed in.
//   joined  `lists` with such layers behind each pixel's own
FragmentLists tiedToPixels(const FragmentLists& lists, FragmentLists joined);

class LayerSource {
 public:
  virtual ~LayerSource() = default;
  virtual const char* name() const = 0;
  // Lists that are handed to the result reach `next` with this source's layers among them.
  virtual ListSink into(const SourceView& view, ListSink next) = 0;
  virtual bool mayScatter() const { return false; }   // its layers may refract or diffuse
  virtual bool wantsRows() const { return false; }    // lists must be as wide as the picture
  virtual bool runsBetween() const { return false; }  // its layers fill what all others leave: it joins behind them
};

std::unique_ptr<LayerSource> deepFiles(std::span<const std::unique_ptr<DeepSource>> files);
// Runs between the surfaces: it must join last. What is marched is settings.fog.
std::unique_ptr<LayerSource> fogRuns();

// The triangles, and whatever joins them.
class LayerSources {
 public:
  //   pass  of the triangles; null when the shot has none
  explicit LayerSources(TransparentPass* pass) : pass_(pass) {}
  void join(std::unique_ptr<LayerSource> source) { joined_.push_back(std::move(source)); }
  void each(const SourceView& view, const ListSink& sink) const;
  bool trianglesAlone() const { return pass_ && joined_.empty(); }
  bool mayScatter(const PassSettings& settings) const;
  TransparentPass* triangles() const { return pass_; }

 private:
  TransparentPass* pass_;
  std::vector<std::unique_ptr<LayerSource>> joined_;
};

}  // namespace pellucid
