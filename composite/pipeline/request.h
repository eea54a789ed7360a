// What is asked of the pipeline, typed: nothing here has been opened or looked up yet. An optional that is empty means
// that the caller left the choice to the plan.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "composite/gather.h"
#include "composite/methods/method.h"
#include "composite/methods/stochastic.h"
#include "composite/pipeline/default_method.h"
#include "composite/pipeline/lens.h"
#include "composite/pipeline/shot_time.h"
#include "engine_bridge/scene/fitted_camera.h"
#include "engine_bridge/scene/fog_grids.h"
#include "engine_bridge/scene/gltf.h"
#include "engine_bridge/scene/pass_settings.h"
#include "gbuffer/medium.h"
#include "gbuffer/opaque_io.h"
#include "gbuffer/pixel_filter.h"
#include "gbuffer/tiers.h"

namespace pellucid {

// What paints: one of these, and a file in painters/ or a mixer for each.
struct PaintSums {};    // the order-independent sums of the transparent pass, resolved
struct PaintSorted {};  // sorted compositing in double precision: the truth
struct PaintListed {    // a method of composite/methods/
  ChosenMethod method;
};
struct PaintSamples {  // stochastic transparency
  StochasticSettings settings;
  bool onDevice = false;
};
struct PaintWithin {       // the sums where they are proved to be good enough, the truth elsewhere
  double tolerance = 0.0;  // times the larger of 1 and the value, every pixel and channel
};
struct PaintCheapest {     // the cheapest of the sums and the truth that lies within it on this shot
  double tolerance = 0.0;  // as above
};
enum class SystemRule { file, node };
struct SystemWeight {
  std::string system;                             // a file as it was given or by its last part, or a node
  std::optional<shading::WeightSettings> weight;  // empty: fitted to that system alone
  bool whole = false;                             // range and reference, too, are as the weight says
};
struct PaintSystems {  // a pass for every input file or named node, sorted coarsely: WB13 section 3.4
  SystemRule rule = SystemRule::file;
  std::optional<ChosenMethod> method;      // within a system; empty: the weighted sum
  std::vector<SystemWeight> weights = {};  // of those that have one of their own; the others share the picture's
};
using Paint = std::variant<PaintSums, PaintSorted, PaintListed, PaintSamples, PaintWithin, PaintCheapest, PaintSystems>;

// How layers are weighed and averaged, where the method reads it.
struct SumsRequest {
  std::optional<shading::WeightSettings> weight;         // kind and exponent; the rest is below
  bool fitWeight = false;                                // --weight auto: fitted to the truth on probe pixels
  std::optional<std::pair<double, double>> weightRange;  // metres; else the camera's, else 0.1 to 1000
  // Metres: of powers of depth, where they weigh 1; else where the scene begins. Of functions whose constants are
  // lengths, the unit of those; else 1.
  std::optional<double> weightReference;
  std::string weightFrom;              // picture or planes whose header says all three, or ""
  std::optional<int> normalisation;    // PLD_NORMALISE_*
  std::optional<bool> selfModulation;  // PT17 eq. 14
};

struct NamedCamera {
  std::string name;  // of the scene
};
struct PlacedCamera {
  glm::dvec3 eye{0.0}, look{0.0, 0.0, -1.0}, up{0.0, 1.0, 0.0};  // world, metres
  double fov = 0.0;                                              // vertical, degrees
};
// Nothing: the picture's own, else the scene's only one. A Camera is taken as it is.
using CameraChoice = std::variant<std::monostate, NamedCamera, PlacedCamera, FittedCamera, Camera>;

struct PictureOfSurroundings {
  std::string path;  // lat-long EXR
};
// Nothing: the median of the sky's pixels. A colour is radiance in the picture's own space, as that median is.
using SurroundingsChoice = std::variant<std::monostate, glm::vec3, PictureOfSurroundings>;

// What says which linear space the picture's colours are in.
struct ColourRequest {
  std::string config;               // of OpenColorIO, a file; "" for the built-in one
  std::string configBy = "--ocio";  // who names it, for messages
  std::string workingSpace = "auto";
  bool operator==(const ColourRequest&) const = default;
};

struct ShotRequest {
  std::string opaque;  // EXR, flat or deep
  // The opaque picture as the caller holds it (memory_picture.h), instead of that file; null: the file. Nothing of it
  // changes while a shot of it is loaded.
  std::shared_ptr<const GBuffer> memory;
  // The picture was rendered of the same inputs a moment ago: its camera is meant, whatever cameras they hold.
  bool renderedHere = false;
  std::vector<std::string> inputs;  // glTF, GLB and deep EXR with the transparent things
  ReadOptions read;
  SceneOptions scene;
  ShotTime time;
  CameraChoice camera;
  SurroundingsChoice surroundings;
  ColourRequest colour;
};

enum class ShadowSource { off, rays, raysOpaque, maps };  // raysOpaque: as if what covers half hid all
enum class ShadowMapForm { variance, published, naive, stratified, corrected };
struct ShadowRequest {
  ShadowSource source = ShadowSource::off;
  ShadowMapForm form = ShadowMapForm::variance;
  std::optional<int> size;                                  // texels along an edge of a map as drawn
  std::vector<std::pair<std::string, std::string>> layers;  // light's name, EXR layer with its part of the beauty
  bool apply = false;                                       // without such layers: multiply the beauty
  std::string views;                                        // EXR to write what the maps hold to, or ""
  std::uint32_t seed = 0;                                   // of the maps' coins
  bool on() const { return source != ShadowSource::off; }
  bool byRays() const { return source == ShadowSource::rays || source == ShadowSource::raysOpaque; }
  bool byMaps() const { return source == ShadowSource::maps; }
  bool operator==(const ShadowRequest&) const = default;
};

struct FogText {
  MediumSettings medium;
  bool hasDensity = false;             // the text says how dense it is
  std::optional<glm::dvec3> emission;  // radiance that a metre adds, of even fog or of an emission grid's 1
  std::optional<double> blackbody;     // 1/m, see GlowSettings::absorption
  std::optional<double> kelvin;        // see GlowSettings
  int shafts = 96;   // texels along the longest edge of the light volume; 0: nothing stands before the lights
  bool zUp = false;  // the grids'
  bool operator==(const FogText&) const = default;
};
struct FogGrid {
  std::string path, name;  // OpenVDB; of the grid, or ""
  GridRole role = GridRole::density;
  bool operator==(const FogGrid&) const = default;
};
struct FogRequest {
  std::optional<FogText> text;  // --fog key=value,...
  std::string file;             // --fog FILE.json, or ""
  std::vector<FogGrid> grids;   // --fog-grid
  bool on() const { return text || !file.empty() || !grids.empty(); }
  bool operator==(const FogRequest&) const = default;
};

// Ambient occlusion of cut-out leaves. apart: planes of what rims get from around, left to `resolve`.
enum class FoliageRule { inferred, solid, off, apart };
struct FoliageRequest {
  FoliageRule rule = FoliageRule::inferred;
  std::optional<int> form;            // PLD_OCCLUSION_*
  std::optional<double> directShare;  // [0,1]
  std::optional<bool> fromFile;       // the picture's AO channel where it has one; false: from depth
  std::optional<double> radius;       // metres; else a tenth of the depth
};

struct LowResolutionRequest {
  std::optional<int> factor;  // pixels per texel, in both axes: 1, 2, 4, 8; else 4
  static constexpr int kDefault = 4;
};

// Extra layers of the output.
enum class LayerName { transparent, transmission, depth, edges, unseen, diffusion, delta, weight, count };

// Pixels whose colour is filtered over an edge of the opaque picture: taken apart into its two surfaces, or left as
// one.
enum class EdgeRule { resolve, off };

struct Request {
  ShotRequest shot;
  std::string method = "over";  // as it was asked for: for headers and messages
  Paint paint = PaintSorted{};
  std::string methodFrom;                 // picture whose header says method and weight, or ""
  std::optional<MethodDecision> decided;  // where nobody asked for a method: why it is this one
  Tier tier = Tier::float32;
  SumsRequest sums;
  int passes = 1;  // jittered, averaged
  // The picture has N x N samples for each pixel of the result, which is their mean: all of them are composited.
  int supersampled = 1;
  // By which the picture was filtered: places of several passes are drawn from it. Else as its header or its producer
  // says, else the pixel's square.
  std::optional<PixelFilter> pixelFilter;
  std::optional<Shutter> shutter;  // each pass at its own time
  LensRequest lens;                // each pass from its own point of it
  std::optional<EdgeRule> edges;   // else resolve, where several passes can be dealt to two surfaces
  TextureFilter filter = TextureFilter::mipmap;
  MaskEdge mask = MaskEdge::smooth;
  ScatterSettings scatter;
  ResidencySettings residency;
  LookupSettings lookup;
  bool resolveOnDevice = false;
  LowResolutionRequest lowResolution;
  FoliageRequest foliage;
  ShadowRequest shadows;
  FogRequest fog;
  int particleLight =
      64;                // texels along the longest edge of what tells particles of the lamps; 0: nothing is in the way
  bool measure = false;  // composite the sorted truth too
  std::vector<LayerName> layers;
  // Of accumulate(): files of planes whose solids hide what stands behind them, so that all of them add up.
  std::vector<std::string> heldOutBy;
  int device = -1;  // EGL device; -1 takes the first
};

template <class Kind>
bool paintsBy(const Request& request) {
  return std::holds_alternative<Kind>(request.paint);
}

}  // namespace pellucid
