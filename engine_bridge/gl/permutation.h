// Which text of the fragment stage a draw needs: a software rasteriser pays for every feature that is compiled in.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/gl/transparent_pass.h"
#include "shaders/plane_layout.h"

namespace pellucid::gl {

enum class Output {
  sums,       // the OIT planes
  count,      // fragments per pixel
  list,       // the fragments themselves
  leanList,   // what compositing by depth reads of them
  solid,      // the nearest fragment that hides everything
  published,  // the targets of PT17 table 2
  rims,       // what rims of leaves get from around: gbuffer/rim_planes.h
  // Stochastic transparency, by the share of samples that see a fragment, or by those that it won:
  cover,       // nearest depths of the samples
  add,         // light
  coverToWin,  // of winners alone
  claim,       // who owns a sample, of those at one depth
  addWon,
};
constexpr std::size_t kOutputs = 12;

struct FrameFeatures {
  MaskEdge mask = MaskEdge::smooth;
  bool lights = false, surroundings = false;
  bool shadows = false;                     // there are maps of what is in the lights' way
  bool shadowRays = false;                  // or rays have found it for every fragment
  bool environment = false;                 // the surroundings are a picture
  bool solids = false;                      // there is a solid plane to test against
  bool grey = false;                        // no material transmits colour: one opacity for all channels
  bool refracts = false, diffuses = false;  // some material of the scene does, and the settings let it
  bool adds = false;                        // some material adds light
  bool disperses = false;                   // refracts, by wavelength
  bool occludes = false;                    // there are occluders for cut-out materials
  int rimForm = -1;                         // PLD_OCCLUSION_* of their rims; < 0 leaves rims open
  bool probes = false;                      // lists of some pixels alone
  bool pieces = false;                      // identities name pieces of triangles
  bool lightVolume = false;                 // what of the lights reaches particles is known
  bool prune = true;                        // else every material gets the text of every phenomenon

  bool scatters() const { return refracts || diffuses; }
};

// What materials have.
struct Needs {
  bool solids = false, adds = false, refracts = false, diffuses = false, disperses = false;
  bool coloured = false, infers = false;  // transmit colour; have rims whose occlusion is inferred

  void addScattering(const Material& material);
};
Needs either(const Needs& a, const Needs& b);

// What layers scatter in a pass with these settings; nothing.
void chooseScattering(const Needs& needs, const PassSettings& settings, FrameFeatures& frame);
void scatterNothing(FrameFeatures& frame);
// What such a pass leaves out, and why.
//   wouldOcclude  with occluders
std::vector<std::string> leftOut(const FrameFeatures& frame, const PassSettings& settings, bool wouldOcclude);

// Defines for shaders/gl/transparent.frag.
//   points  the primitive's triangles are particles
//   infers  the material's rims take their occlusion from their neighbours (infersOcclusion)
std::vector<std::string> surfaceDefines(const Material& material, bool vertexColours, const FrameFeatures& frame,
                                        bool infers = false, bool points = false);
std::vector<std::string> outputDefines(Output output, const FrameFeatures& frame, const SumsSettings& sums);
// What the layers of such a frame are summed in.
LayerModel layersOf(const FrameFeatures& frame, const SumsSettings& sums);

}  // namespace pellucid::gl
