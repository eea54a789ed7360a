#include "engine_bridge/c/plane_set.h"

#include <algorithm>

#include "engine_bridge/gl/plane_formats.h"

namespace pellucid::c {

namespace {

GLuint placeOf(const Plane& plane) {
  return static_cast<GLuint>(plane.spec.target);
}

}  // namespace

std::vector<Plane> planesFrom(const std::vector<PlaneSpec>& specs) {
  std::vector<Plane> planes;
  for (const PlaneSpec& spec : specs) planes.push_back({spec, 0});
  return planes;
}

bool makePlanes(const Device& device, GLuint frame, std::vector<Plane>& planes, int width, int height,
                uint64_t& bytes) {
  GLenum buffers[kDrawBuffers];
  std::fill(std::begin(buffers), std::end(buffers), GLenum{GL_NONE});
  for (Plane& plane : planes) {
    plane.texture = device.makeTexture(gl::formatOf(plane.spec.format), width, height, plane.spec.bits(), bytes);
    buffers[placeOf(plane)] = GL_COLOR_ATTACHMENT0 + placeOf(plane);
    device.attach(frame, buffers[placeOf(plane)], plane.texture);
  }
  device.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
  device.gl.DrawBuffers(kDrawBuffers, buffers);
  return device.isComplete();
}

void releasePlanes(const Device& device, std::vector<Plane>& planes) {
  for (Plane& plane : planes) device.releaseTexture(plane.texture);
}

void clearPlanes(const GlFunctions& gl, const std::vector<Plane>& planes) {
  for (const Plane& plane : planes) gl.ClearBufferfv(GL_COLOR, plane.spec.target, plane.spec.clear.data());
}

void setBlending(const GlFunctions& gl, const std::vector<Plane>& planes) {
  for (const Plane& plane : planes) {
    const gl::BlendWords blend = gl::blendOf(plane.spec.blend);
    gl.Enablei(GL_BLEND, placeOf(plane));
    gl.BlendFuncSeparatei(placeOf(plane), blend.source, blend.destination, GL_ONE, GL_ONE);
    gl.BlendEquationSeparatei(placeOf(plane), blend.equation, blend.alphaEquation);
  }
}

void bindPlanes(const Device& device, const std::vector<Plane>& planes) {
  for (const Plane& plane : planes) device.bind(static_cast<GLuint>(plane.spec.unit), plane.texture);
}

GLuint textureOf(const std::vector<Plane>& planes, PlaneSum sum) {
  for (const Plane& plane : planes)
    if (plane.spec.sum == sum) return plane.texture;
  return 0;
}

void PlaneSet::create() {
  for (GLuint* frame : {&layersFrame_, &frontFrame_, &solidFrame_, &planarFrame_}) device_.makeFrame(*frame);
  const Permutation& p = device_.permutation;
  layers_ = planesFrom(planesOf(p));
  if (p.frontStage()) front_ = planesFrom(pellucid::planesOf(modelOf(p), PlaneStage::front));
  if (p.has(PLD_FEATURE_SOLIDS)) solids_ = planesFrom(pellucid::planesOf(modelOf(p), PlaneStage::solids));
}

void PlaneSet::destroy() {
  release();
  for (GLuint* frame : {&layersFrame_, &frontFrame_, &solidFrame_, &planarFrame_}) device_.releaseFrame(*frame);
}

void PlaneSet::release() {
  for (std::vector<Plane>* planes : {&layers_, &front_, &solids_}) releasePlanes(device_, *planes);
  for (GLuint* one : {&planarZ_, &solidDepth_}) device_.releaseTexture(*one);
  bytes_ = 0;
}

bool PlaneSet::make(int width, int height) {
  const Permutation& p = device_.permutation;
  const auto make = [&](GLenum format, int bits) { return device_.makeTexture(format, width, height, bits, bytes_); };
  bool complete = makePlanes(device_, layersFrame_, layers_, width, height, bytes_);
  if (p.planarDepth()) {
    planarZ_ = make(GL_R32F, 32);
    device_.attach(planarFrame_, GL_COLOR_ATTACHMENT0, planarZ_);
    complete = device_.isComplete() && complete;
  }
  if (!front_.empty()) complete = makePlanes(device_, frontFrame_, front_, width, height, bytes_) && complete;
  if (solids_.empty()) return complete;
  complete = makePlanes(device_, solidFrame_, solids_, width, height, bytes_) && complete;
  if (p.exact()) return complete;
  solidDepth_ = make(GL_DEPTH_COMPONENT32F, 32);
  device_.attach(solidFrame_, GL_DEPTH_ATTACHMENT, solidDepth_);
  return device_.isComplete() && complete;
}

}  // namespace pellucid::c
