/* A host that knows Pellucid from an installed prefix alone, in C: two panes over a grey wall, and what the picture
 * must be. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#define GL_GLEXT_PROTOTYPES 1
#include <GL/glcorearb.h>
#include <pellucid/pellucid.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 32, HEIGHT = 16 };

static pld_proc address(void* user, const char* name) {
  (void)user;
  return (pld_proc)eglGetProcAddress(name);
}

static void message(void* user, pld_log_level level, const char* text) {
  (void)user;
  fprintf(stderr, "log %d: %s\n", (int)level, text);
}

static void need(int fine, const char* what) {
  if (!fine) {
    fprintf(stderr, "outside: %s\n", what);
    exit(1);
  }
}

static GLuint texture(GLenum format) {
  GLuint name;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glTextureStorage2D(name, 1, format, WIDTH, HEIGHT);
  return name;
}

static GLuint shader(GLuint program, GLenum kind, const char* const* text, GLsizei count) {
  GLint done = 0;
  GLuint name = glCreateShader(kind);
  glShaderSource(name, count, (const GLchar* const*)text, NULL);
  glCompileShader(name);
  glGetShaderiv(name, GL_COMPILE_STATUS, &done);
  need(done, "a shader does not compile");
  glAttachShader(program, name);
  return name;
}

int main(void) {
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  PFNEGLGETPLATFORMDISPLAYEXTPROC get = (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
  EGLDisplay display = get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
  need(eglInitialize(display, NULL, NULL) && eglBindAPI(EGL_OPENGL_API), "no EGL");
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  need(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context), "no OpenGL 4.5");
  need(pld_version() >= PLD_VERSION, "the library is older than its header");

  pld_create_info info = {0};
  info.struct_size = sizeof(info);
  info.version = PLD_VERSION;
  info.get_proc_address = address;
  info.log = message;
  info.method = PLD_METHOD_WEIGHTED;
  info.weight = PLD_WEIGHT_BY_NONE;
  info.features = PLD_FEATURE_COLOURED;
  info.depth = PLD_DEPTH_DEVICE;
  pld_pass* pass = NULL;
  need(pld_create(&info, &pass) == PLD_OK && pld_resize(pass, WIDTH, HEIGHT) == PLD_OK, "no pass");

  const float wall[4] = {0.5f, 0.5f, 0.5f, 1.0f}, far = 1.0f;
  GLuint colour = texture(GL_RGBA16F), depth = texture(GL_DEPTH_COMPONENT24), picture = texture(GL_RGBA32F);
  glClearTexImage(colour, 0, GL_RGBA, GL_FLOAT, wall);
  glClearTexImage(depth, 0, GL_DEPTH_COMPONENT, GL_FLOAT, &far);

  /* The left half is covered by both panes, the right half by none. */
  const char* seam = NULL;
  need(pld_glsl(pass, PLD_STAGE_LAYERS, 330, &seam) == PLD_OK, "no seam");
  const char* vertex[] = {"#version 330 core\nvoid main() { vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1);"
                          "gl_Position = vec4(c.x - 1.0, c.y * 2.0 - 1.0, 0.0, 1.0); }"};
  const char* fragment[] = {"#version 330 core\n", seam,
                            "uniform vec4 pane; void main() {"
                            "pldWriteFragment(pldSurface(vec3(pane.a), 1.0, pane.rgb, vec3(0.0, 0.0, -2.0))); }"};
  GLuint program = glCreateProgram(), array;
  shader(program, GL_VERTEX_SHADER, vertex, 1);
  shader(program, GL_FRAGMENT_SHADER, fragment, 3);
  glLinkProgram(program);
  need(pld_connect(pass, program) == PLD_OK, pld_message(pass));
  glCreateVertexArrays(1, &array);

  pld_frame frame = {0};
  frame.struct_size = sizeof(frame);
  frame.colour_texture = colour;
  frame.depth_texture = depth;
  frame.width = WIDTH;
  frame.height = HEIGHT;
  frame.projection[0] = frame.projection[5] = 1.0f;
  frame.projection[10] = -1.002f;
  frame.projection[11] = -1.0f;
  frame.projection[14] = -0.2002f;
  frame.metres_per_unit = frame.pre_exposure = 1.0f;
  frame.weight_near = 0.1f;
  frame.weight_far = 100.0f;
  need(pld_begin(pass, PLD_STAGE_LAYERS, &frame) == PLD_OK, pld_message(pass));
  glUseProgram(program);
  glBindVertexArray(array);
  const float panes[2][4] = {{0.9f, 0.5f, 0.2f, 0.0f}, {0.5f, 0.5f, 0.5f, 0.1f}};
  for (int i = 0; i < 2; ++i) {
    glUniform4fv(glGetUniformLocation(program, "pane"), 1, panes[i]);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  need(pld_end(pass) == PLD_OK, pld_message(pass));
  pld_target target = {0};
  target.struct_size = sizeof(target);
  target.kind = PLD_TARGET_TEXTURE;
  target.name = picture;
  need(pld_resolve(pass, &target) == PLD_OK, pld_message(pass));

  static float texels[HEIGHT][WIDTH][4];
  glGetTextureImage(picture, 0, GL_RGBA, GL_FLOAT, sizeof(texels), texels);
  for (int c = 0; c < 3; ++c) {
    /* beta b + (1 - beta) sum(C) / sum(o), by hand */
    const double beta = (double)panes[0][c] * (double)panes[1][c], o = 2.0 - (double)panes[0][c] - (double)panes[1][c];
    const double left = beta * 0.5 + (1.0 - beta) * 0.1 / o;
    printf("channel %d: %.6f, expected %.6f; beside it %.6f\n", c, (double)texels[8][4][c], left,
           (double)texels[8][28][c]);
    need(fabs((double)texels[8][4][c] - left) < 1e-6, "the panes are wrong");
    need(texels[8][28][c] == 0.5f, "the bare wall is wrong");
  }
  need(pld_destroy(&pass) == PLD_OK && pass == NULL && glGetError() == GL_NO_ERROR, "not tidy");
  puts("rendered");
  return 0;
}
