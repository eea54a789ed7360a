// Draws the transparent triangles of a scene over one super-tile with any output: what sums, solids, counts and lists
// have in common. Owns and restores no state of others: the context is ours.
#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "engine_bridge/gl/fog_pass.h"
#include "engine_bridge/gl/frame_blocks.h"
#include "engine_bridge/gl/geometry_stream.h"
#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/permutation.h"
#include "engine_bridge/gl/scene_textures.h"
#include "engine_bridge/gl/shadow_ray_table.h"
#include "engine_bridge/gl/shadow_textures.h"
#include "engine_bridge/gl/targets.h"
#include "engine_bridge/gl/volume_texture.h"
#include "engine_bridge/scene/placed.h"

namespace pellucid::gl {

class Renderer {
 public:
  Renderer(const Scene& scene, const GBuffer& gbuffer, const Camera& camera);

  // The scene has been posed anew, or the camera has moved: everything is placed again. Programs and textures stay.
  void pose(const Camera& camera);

  // From now on draws over another picture, from the same place through a lens or a window that may differ.
  void over(const GBuffer& gbuffer, const Camera& camera);

  // Parts of the data window that are drawn at once, in pixels of its top left corner, row by row.
  //   settings  what their area does not meet is left out
  std::vector<Window> superTiles(const PassSettings& settings) const;

  // Camera, opaque depth and targets for one of them, and its solid plane.
  void begin(const Window& superTile, const PassSettings& settings, std::size_t geometryBytes);

  // Instead of begin(), draws only the depth of the nearest solids: into the plane of the data window.
  void solidDepth(const Window& superTile, const PassSettings& settings, std::size_t geometryBytes, Image<float>& z);

  // Everything with this output, clipped to each scissor in turn (pixels of the super-tile).
  void draw(Output output, const std::vector<Window>& scissors);
  // Pixels per row and origin of the list buffers.
  void setBand(const Window& band);

  Targets& targets() { return *targets_; }
  // What the layers are summed in, after begin().
  LayerModel layers() const { return layersOf(features_, settings_); }
  // What they are as Output::list has them, after begin().
  LayerModel listedLayers() const { return layersOf(features_, SumsSettings()); }
  const FrameFeatures& features() const { return features_; }
  bool hasSolids() const { return features_.solids; }
  bool scatters() const { return features_.scatters(); }
  // Whether a pass with these settings would.
  bool wouldScatter(const PassSettings& settings) const;
  bool wouldOcclude(const PassSettings& settings) const;
  bool occludes() const { return features_.occludes; }
  // What a full-screen pass over the sums of a super-tile needs to know, after begin().
  FogFrame fogFrame(const Window& superTile) const;
  // Scissor tiles of the super-tile, as PassSettings::tile wants them; of PassSettings::area alone.
  std::vector<Window> tiles() const;
  // The part of the super-tile that is drawn, in its pixels.
  Window drawnPart() const;
  bool picksTiles() const { return settings_.tile == 0; }
  const GeometryStream& geometry() const { return stream_; }
  // Of shadow rays, since the last call.
  ShadowRayTable::Counts takeShadowRayCounts() { return std::exchange(rayCounts_, {}); }

 private:
  struct Shader {  // per primitive
    std::vector<std::string> surface;
    bool vertexColours;
    bool canBeSolid;
    bool infers = false;                     // its rims take their occlusion from their neighbours
    const Program* programs[kOutputs] = {};  // by Output, looked up once per begin()
  };
  void place();
  void classify();
  Needs needsOf(const PassSettings& settings) const;
  const Program& programFor(int primitive, Output output);
  void uploadFrame();
  void uploadSurroundings();
  void uploadShadows();
  void describeSurfaces();
  void traceShadows(const Window& superTile);
  void drawSolids();
  void setBody(const Program& program, const Primitive& primitive, const Placed& placed);
  void drawChunk(const std::vector<ChunkDraw>& draws, Output output);

  const Scene& scene_;
  const GBuffer* gbuffer_;
  double nearest_;  // metres, of its depths
  Camera camera_;
  SceneTextures textures_;
  GeometryStream stream_;
  Buffer frameBuffer_, materialBuffer_, lightBuffer_;
  std::size_t materialStride_ = 0;
  std::vector<Placed> placed_;  // per instance
  std::vector<Shader> shaders_;
  int lights_ = 0;
  Needs needs_[2];  // of the materials of full, of low resolution

  void chooseFeatures(const PassSettings& settings);
  void prepare(const Window& superTile, const PassSettings& settings, std::size_t geometryBytes);
  void uploadDepth(const Window& superTile);
  void uploadOccluders(const Window& superTile);

  PassSettings settings_;
  std::size_t geometryBytes_ = 0;
  FrameFeatures features_;
  FrameBlock frame_;
  std::optional<Targets> targets_;
  Texture opaqueZ_, atlas_, occluders_;
  VolumeTexture particleLight_;
  std::shared_ptr<const Surroundings> atlasOf_;  // what atlas_ holds
  std::shared_ptr<const ShadowMaps> shadowsOf_;  // what shadows_ holds
  std::optional<ShadowTextures> shadows_;
  ShadowRayTable rayTable_;
  ShadowRayTable::Counts rayCounts_;
  bool tracing_ = false;                              // only what shadow rays are traced for is drawn
  Window areaOf(const PassSettings& settings) const;  // in pixels of the data window
  Window opaqueZPart_, occludersPart_;
  bool opaqueZIsOld_ = false;  // opaqueZ_ holds the depth of another picture
  Window superTile_;
  std::shared_ptr<const OccluderPlanes> uploadedOccluders_;
};

}  // namespace pellucid::gl
