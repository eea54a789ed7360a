// The GL state that this library touches: the whole list, saved and put back. INTEGRATION.md names it for hosts.
#pragma once
#include <cstddef>

#include "engine_bridge/c/gl_functions.h"

namespace pellucid::c {

constexpr int kMostUnits = 32;  // of which a host may choose for the seam

// A run of texture units: GL_TEXTURE_2D and sampler bindings of first .. first + count - 1.
struct Units {
  int first = 0, count = 0;
};

// A run of storage buffer bindings. None at all, and the generic binding is not touched either.
constexpr int kMostStorage = 6;
struct Storage {
  int first = -1, count = 0;
};

class SavedState {
 public:
  // uniformBinding < 0: no indexed uniform buffer is touched.
  void save(const GlFunctions& gl, Units units, int uniformBinding, Storage storage = {});
  // Put back what save() saw; objects that the host has deleted since are left unbound.
  void restore(const GlFunctions& gl) const;
  // What the host's own draws of a stage go by, after a draw of ours: culling, polygon mode, clipping, program and
  // vertex array.
  void restoreForDraws(const GlFunctions& gl) const;
  void restoreActiveUnit(const GlFunctions& gl) const;

  // Whether something that the host leaves alone between a begin and its end was another when `before` was saved, with
  // the same arguments. `what` names the first such thing: "the draw framebuffer", "blending of draw buffer 2".
  bool differs(const SavedState& before, char* what, std::size_t size) const;

 private:
  const char* differentDrawing(const SavedState& before) const;
  const char* differentPlace(const SavedState& before, int& place) const;
  void restoreShape(const GlFunctions& gl) const;
  void restoreUnit(const GlFunctions& gl, int i) const;
  void restoreObjects(const GlFunctions& gl) const;
  // Of one target, generic and of a run of places.
  struct Bound {
    GLint buffer;
    GLint64 start, size;
  };
  static Bound boundAt(const GlFunctions& gl, GLenum target, GLenum start, GLenum size, GLuint index);
  static void bindAgain(const GlFunctions& gl, GLenum target, GLuint index, const Bound& bound);
  struct Blend {
    GLboolean enabled, mask[4];
    GLint sourceRgb, targetRgb, sourceAlpha, targetAlpha, equationRgb, equationAlpha;
    bool blendsAs(const Blend& other) const;
  };
  Units units_;
  int uniformBinding_ = -1;
  GLint program_ = 0, vertexArray_ = 0, drawFramebuffer_ = 0, activeTexture_ = 0;
  GLfloat viewport_[4] = {};
  Blend blend_[kDrawBuffers] = {};
  GLboolean depthMask_ = GL_FALSE;
  GLint depthFunction_ = 0, polygonMode_[2] = {};
  GLboolean enabled_[20] = {};
  GLboolean scissor_ = GL_FALSE;
  GLint textures_[kMostUnits] = {}, samplers_[kMostUnits] = {};
  GLint uniformBuffer_ = 0, storageBuffer_ = 0;
  Bound uniforms_{};
  Storage storage_;
  Bound listed_[kMostStorage] = {};
};

void setViewportTo(const GlFunctions& gl, int x, int y, int width, int height);
// Of the draw buffers from `first` on.
void setColourMask(const GlFunctions& gl, GLuint first, bool written);
// All that could keep a draw of the library's own from its pixels. The viewport is (0, 0, width, height).
void setPlainDrawing(const GlFunctions& gl, int width, int height);
// The part of it that would falsify sums; culling, polygon mode and clipping stay the host's.
void setAccumulation(const GlFunctions& gl, int width, int height);

}  // namespace pellucid::c
