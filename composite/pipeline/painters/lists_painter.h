// Painting from fragment lists: what all methods that work from them share. A mixer says how one pixel's list becomes
// light and transmission; what the layers show of the background, solids, deep pictures and low resolution are here.
#pragma once
#include "composite/pipeline/painter.h"

namespace pellucid {

// What a mixer is told besides the lists.
struct Mixed {
  const PassSettings& sample;
  int pass;            // its number
  const Window& data;  // of the veil
  // Of `data`; null where a pixel shows several, and where a part of the picture is painted.
  const Image<glm::vec4>* background = nullptr;
  const OitPlanes* scatter = nullptr;  // which pixels look elsewhere; null: none
  const HeldOutRow* row = nullptr;     // the lists are the entries of a deep picture's row
};

class Mixer {
 public:
  virtual ~Mixer() = default;
  // Writes the veil of the lists' window, which lies inside `mixed.data`.
  virtual void mix(const Mixed& mixed, const FragmentLists& lists, Veil& veil) = 0;
  // Once all windows of a pass are mixed.
  //   scatter  what looks the background up elsewhere; without planes of scattering where nothing does
  virtual void endPass(const OitPlanes& scatter) { (void)scatter; }
  virtual bool settled() { return true; }
  virtual void finish(Veil& mean) { (void)mean; }
  virtual VolumeRule rule() const { return VolumeRule::midDepth; }
  virtual bool exactScatter() const { return false; }         // what scatters is summed so that no order shows
  virtual bool fogBeside(const Fog&) const { return false; }  // it adds fog itself, where a row is mixed
  // Composites what is drawn at low resolution, of the view's window.
  virtual void mixTexels(const Mixed& mixed, const FragmentLists& lists, Veil& veil);
  virtual bool cutsTexels() const { return false; }  // those are cut into runs by the layers of full resolution
  // Depth and colour alone are read, in any blocks: lean lists will do.
  virtual bool takesLean() const { return false; }
  virtual void mixLean(const LeanLists& lists, const Window& data, Veil& veil);
};

std::unique_ptr<Mixer> methodMixer(const ChosenMethod& method);  // a method of composite/methods/, pixel by pixel

std::unique_ptr<Painter> listsPainter(const PaintContext& context, std::unique_ptr<Mixer> mixer);

}  // namespace pellucid
