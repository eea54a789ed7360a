// Deep files as transparent layers: their samples join the fragment lists of a shot.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "composite/deep/sample_channels.h"
#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

class DeepSource {
 public:
  // Throws what resolveDeep and DeepReader throw, and MeaningError when the display window is not the shot's.
  //   depth  from the file's numbers; those that `fragments` wrote are planar in any case
  //   view   what --view says
  DeepSource(const std::string& path, const DepthConverter& depth, const GBuffer& shot, std::uint32_t index,
             const std::string& view = "");
  const std::string& path() const { return path_; }
  // Brings what its samples send and let through into the picture's space, where the file states another.
  void bringInto(const ColourSpace& space);
  bool mayScatter() const { return channels_.hasRecord(); }  // samples say how they refract and diffuse
  std::vector<std::string> notes() const;                    // what was skipped or clamped so far

 private:
  friend class DeepMerge;
  std::string path_;
  DepthConverter depth_;
  std::uint32_t index_;
  DeepChannels channels_;
  DeepReader reader_;
  std::optional<glm::dmat3> toSpace_;  // empty: its colours are in the picture's space already
  DeepOddities oddities_;
};

// How a volume sample becomes fragments, which have no thickness.
enum class VolumeRule {
  split,     // at every other sample's depth: sorted compositing of the pieces is exact
  midDepth,  // one fragment, half way: what order-independent methods take
};

// Adds the samples that lie in front of the G-buffer and of solids to the lists, and hands on the result in bands of
// whole rows of the lists' window with about `most` deep samples each. An opaque sample becomes the pixel's solid. A
// volume that the G-buffer's surface or a solid cuts keeps the part before it.
void mergeDeep(const FragmentLists& lists, std::span<const std::unique_ptr<DeepSource>> sources, const GBuffer& shot,
               VolumeRule rule, std::uint64_t most, const std::function<void(const FragmentLists&)>& band);

}  // namespace pellucid
