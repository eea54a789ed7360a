// Layers that are drawn at a part of the resolution, and how they enter the sums of the whole.
#include "engine_bridge/c/pass.h"

using namespace pellucid::c;

// Nothing among its layers is solid or waits for its occlusion; nearest depths are wanted besides.
Permutation pld_pass::lowPermutation() const {
  Permutation low = permutation_;
  low.atLowResolution = true;
  low.method = PLD_METHOD_WEIGHTED;  // of one texel
  low.features &= ~static_cast<uint32_t>(PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS);
  return low;
}

std::vector<PlaneSpec> pld_pass::lowPlanes() const {
  std::vector<PlaneSpec> planes = planesOf(lowPermutation());
  if (!permutation_.scatters()) planes.push_back(nearestPlane());
  return planes;
}

std::string pld_pass::buildLowPrograms() {
  std::vector<std::string> solids, upsample{"NORMALISATION 0"};
  if (!permutation_.has(PLD_FEATURE_SOLIDS)) solids.emplace_back("NO_SOLIDS");
  upsample.insert(upsample.end(), solids.begin(), solids.end());
  if (permutation_.grey()) upsample.emplace_back("GREY");
  if (permutation_.scatters()) upsample.emplace_back("SCATTER");
  for (const std::string& place : scatterPlaces(permutation_)) upsample.push_back(place);
  if (permutation_.has(PLD_FEATURE_DISPERSION)) upsample.emplace_back("DISPERSION");
  if (permutation_.tier == PLD_TIER_HALF) upsample.emplace_back("HALF");
  if (permutation_.lowOver()) upsample.emplace_back("FRONT_TAIL");
  std::string failure = lowDepth_.build(gl, "gl/low_depth.frag", solids);
  // A texel's own light: what it bends and spreads is taken from its sums.
  std::vector<std::string> texel = resolveDefines(lowPermutation());
  std::erase(texel, "SCATTER");
  std::erase(texel, "DISPERSION");
  if (failure.empty()) failure = lowTexel_.build(gl, "gl/low_texel.frag", texel);
  if (failure.empty()) failure = upsample_.build(gl, "gl/upsample.frag", upsample);
  return failure;
}

// For factor 2, so that every factor has room.
bool pld_pass::makeLowTextures(int width, int height) {
  const int wide = (width + 1) / 2, high = (height + 1) / 2;
  const auto attach = [&](GLuint frame, GLenum attachment, GLuint texture) {
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
  };
  bool complete = true;
  const auto check = [&] {
    complete = complete && gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  };
  lowFarZ_ = makeTexture(GL_R32F, wide, high, 32);
  attach(lowDepthFrame_, GL_COLOR_ATTACHMENT0, lowFarZ_);
  check();
  GLenum buffers[kDrawBuffers] = {};
  for (Plane& plane : low_) {
    plane.texture = makeTexture(plane.spec.format, wide, high, plane.spec.bits);
    buffers[plane.spec.attachment] = GL_COLOR_ATTACHMENT0 + plane.spec.attachment;
    attach(lowFrame_, buffers[plane.spec.attachment], plane.texture);
  }
  gl.DrawBuffers(kDrawBuffers, buffers);
  check();
  GLenum all[kLowTexels];
  for (GLuint i = 0; i < kLowTexels; ++i) {
    lowTexels_[i] = makeTexture(GL_RGBA32F, wide, high, 128);
    all[i] = GL_COLOR_ATTACHMENT0 + i;
    attach(lowTexelFrame_, all[i], lowTexels_[i]);
  }
  gl.DrawBuffers(kLowTexels, all);
  check();
  if (!permutation_.lowOver()) return complete;
  // The sums of the layers, and in place of the nearest what lies before it.
  GLenum over[kDrawBuffers] = {};
  for (const Plane& plane : planes_) {
    const GLuint i = plane.spec.attachment;
    over[i] = GL_COLOR_ATTACHMENT0 + i;
    const bool front = i == 6 || i == 7, one = i == 7 && permutation_.grey();
    if (front) lowOver_[i - 6] = makeTexture(one ? GL_R32F : GL_RGBA32F, width, height, one ? 32 : 128);
    attach(lowOverFrame_, over[i], front ? lowOver_[i - 6] : plane.texture);
  }
  gl.DrawBuffers(kDrawBuffers, over);
  check();
  return complete;
}

void pld_pass::drawLowDepth(const pld_frame& frame) {
  setPlainDrawing(gl, frame.width / frame.low_factor, frame.height / frame.low_factor);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, lowDepthFrame_);
  const GLuint seam = info_.texture_unit;  // bound again by the stage
  bind(seam, planarZ_);
  if (solid_) bind(seam + 1, solid_);
  useProgram(lowDepth_);
  gl.Uniform1i(lowDepth_.place(gl, "opaqueZ"), static_cast<GLint>(seam));
  gl.Uniform1i(lowDepth_.place(gl, "solid"), static_cast<GLint>(seam + 1));
  gl.Uniform2i(lowDepth_.place(gl, "pictureSize"), frame.width, frame.height);
  gl.Uniform1i(lowDepth_.place(gl, "factor"), frame.low_factor);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

void pld_pass::addLow() {
  const int wide = frame_.width / frame_.low_factor, high = frame_.height / frame_.low_factor;
  setPlainDrawing(gl, wide, high);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, lowTexelFrame_);
  for (const Plane& plane : low_) bind(plane.spec.unit, plane.texture);
  bind(5, lowFarZ_);
  useProgram(lowTexel_);
  gl.Uniform2i(lowTexel_.place(gl, "pictureSize"), wide, high);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);

  setAccumulation(gl, frame_.width, frame_.height);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, permutation_.lowOver() ? lowOverFrame_ : layersFrame_);
  for (GLuint i = 0; i < kDrawBuffers; ++i) gl.ColorMaski(i, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  for (const Plane& plane : planes_) {
    const GLuint i = plane.spec.attachment;
    gl.ColorMaski(i, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    blend(i, plane.spec.blend);
  }
  const GLfloat none[4] = {0, 0, 0, 0};
  if (permutation_.lowOver())
    for (GLint i = 6; i < kDrawBuffers; ++i) gl.ClearBufferfv(GL_COLOR, i, none);
  for (GLuint i = 0; i < kLowTexels; ++i) bind(i, lowTexels_[i]);
  bind(3, planarZ_);
  if (permutation_.lowOver()) bind(5, frontZ_);
  if (solid_) bind(4, solid_);
  constexpr GLuint scatterUnits[] = {6, 7, 5, 8};  // of the planes of targets 4 to 7
  for (const Plane& plane : low_)
    if (plane.spec.attachment >= 4 && permutation_.scatters())
      bind(scatterUnits[plane.spec.attachment - 4], plane.texture);
  useProgram(upsample_);
  gl.Uniform1f(upsample_.place(gl, "factor"), static_cast<float>(frame_.low_factor));
  gl.Uniform2i(upsample_.place(gl, "texelCount"), wide, high);
  gl.Uniform1f(upsample_.place(gl, "texelsAPixel"), 1.0f / static_cast<float>(frame_.low_factor));
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}
