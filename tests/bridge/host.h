// An engine, as far as tests need one: a context, textures, and GL entry points that are counted.
#pragma once
#include <epoxy/gl.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine_bridge/gl/transparent_pass.h"
#include "engine_bridge/include/pellucid/pellucid.h"
#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"

namespace pellucid::test {

// What eglGetProcAddress gives.
pld_proc procAddress(void*, const char* name);

// Keeps everything that is logged, most severe or not.
struct Log {
  std::vector<std::string> lines;
  static void add(void* user, pld_log_level level, const char* text);
  std::string last() const { return lines.empty() ? "" : lines.back(); }
};

GLuint makeTexture(GLenum format, int width, int height);
// Texels as floats: GL_RED or GL_RGBA.
void fillTexture(GLuint name, int width, int height, GLenum format, const float* texels);
std::vector<float> readTexture(GLuint name, int width, int height, GLenum format);

// Of a program made of these stages; expects both to compile and to link, else prints why and gives 0.
GLuint makeProgram(const std::string& vertex, const std::string& fragment);
extern const char* const kFullscreenVertex;

// A host with a picture and its linear depth; row 0 is the top row.
class Host {
 public:
  Host(int width, int height);
  ~Host();
  pld_create_info info() const;  // float tier, phenomenological, linear depth
  pld_frame frame() const;       // of the host's textures
  pld_target target() const;
  // Expects it to succeed.
  pld_pass* create(const pld_create_info& info);
  void upload(const GBuffer& gbuffer);        // colour and depth
  std::vector<float> picture() const;         // of the target
  std::vector<float> finish(pld_pass* pass);  // resolves, destroys the pass, and gives the picture

  int width, height;
  GLuint colour, depth, output, occlusion;
  float opacity = 0.5f;  // pld_frame.depth_opacity
  mutable Log log;
};

// Draws over the whole target with a stage's seam and this main(), and ends the stage. GLSL 3.30.
void drawOverAll(pld_pass* pass, pld_stage stage, const pld_frame& frame, const std::string& main);
// What a view resolves to.
std::vector<float> seen(const Host& host, pld_pass* pass, pld_view view);

// What a replayed fragment tells of itself, by its Fragment::identity: motion in pixels, and identity.
struct ToldMarks {
  float motion[2];
  std::uint32_t identity;
};
ToldMarks marksOf(std::uint32_t identity);

// Blends the lists, fragment by fragment in their order, as a host's shader with the seam does. Stages and resolve
// included.
void replay(pld_pass* pass, const FragmentLists& lists, const pld_frame& frame, const std::vector<pld_stage>& stages);

}  // namespace pellucid::test
