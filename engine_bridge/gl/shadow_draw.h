// Draws what a light sees of a scene into parts of a shadow map's face: casters of both kinds.
#pragma once
#include <memory>
#include <vector>

#include "engine_bridge/gl/frame_blocks.h"
#include "engine_bridge/gl/geometry_stream.h"
#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/scene_textures.h"
#include "engine_bridge/gl/shadow_filter.h"
#include "engine_bridge/gl/shadow_pass.h"
#include "engine_bridge/scene/light_views.h"
#include "engine_bridge/scene/placed.h"

namespace pellucid::gl {

// A face of some light, and how depths are written.
struct ShadowFaceJob {
  LightView view;
  bool radial;
  double scale, offset;  // of LightViews
  int edge;              // texels
  std::uint32_t seed;    // of the map
};

class ShadowDrawer {
 public:
  //   gbuffer  null: only the scene's opaque primitives are opaque
  ShadowDrawer(const Scene& scene, const Camera& camera, const GBuffer* gbuffer, const ShadowMapSettings& settings);

  bool grey() const { return grey_; }
  // Whether anything opaque is known.
  bool hasOpaque() const { return sceneIsOpaque_ || gbuffer_; }

  // From now on of this face.
  void begin(const ShadowFaceJob& job);
  // Rows [first, first + count) of the face, which may lie beyond it.
  DrawnBand casters(int first, int count);
  Image<float> opaque(int first, int count);
  std::size_t triangles() const { return stream_.triangles(); }

 private:
  struct Look {  // of a primitive
    std::vector<std::string> defines;
    const Program* program = nullptr;
    bool casts = false, bothSides = true;
  };
  void beginPart(int first, int count);
  void drawOpaque();
  void drawCasters();

  const Scene& scene_;
  Camera camera_;
  const GBuffer* gbuffer_;
  ShadowMapSettings settings_;
  bool grey_ = true, sceneIsOpaque_ = false;
  SceneTextures textures_;
  GeometryStream stream_, opaqueStream_;
  std::vector<Look> looks_;
  std::vector<Placed> placed_;
  ShadowFaceJob job_{};
  Buffer frameBuffer_, shadowBuffer_, materialBuffer_;
  std::size_t materialStride_ = 0;
  Texture pictureZ_, opaque_, nearest_, steps_;
  Framebuffer opaqueFrame_, casterFrame_;
  VertexArray noVertices_;
  int width_ = 0, height_ = 0;
};

}  // namespace pellucid::gl
