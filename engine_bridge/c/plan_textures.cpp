#include "engine_bridge/c/plan_textures.h"

#include <algorithm>

#include "engine_bridge/c/plan_sizes.h"
#include "engine_bridge/c/plan_words.h"

namespace pellucid::c {

bool PlanTextures::drawsToOwn(const PlannedPass& pass) const {
  return !pass.attachments.empty() && isOwn(pass.attachments[0].image);
}

void PlanTextures::create(const RecipePlan& plan) {
  plan_ = &plan;
  textures_.assign(plan.images.size(), 0);
  frames_.assign(plan.passes.size(), 0);
  for (const PlannedPass& pass : plan.passes)
    if (drawsToOwn(pass)) device_.makeFrame(frames_[indexOf(pass)]);
  // Draws of the exact tier are followed by a pass that reads what they list.
  for (std::size_t i = 0; i + 1 < frames_.size(); ++i)
    if (plan.passes[i].kind == PLD_PASS_DRAWS && plan.passes[i].attachments.empty()) frames_[i] = frames_[i + 1];
}

void PlanTextures::destroy() {
  release();
  for (std::size_t i = 0; i < frames_.size(); ++i)
    if (drawsToOwn(plan_->passes[i])) device_.releaseFrame(frames_[i]);
  frames_.clear();
}

void PlanTextures::release() {
  for (GLuint& one : textures_) device_.releaseTexture(one);
  bytes_ = 0;
}

bool PlanTextures::make(int width, int height) {
  for (uint32_t i = 0; i < textures_.size(); ++i) {
    const PlannedImage& image = plan_->images[i];
    const PixelSize size = sizeOf(*plan_, image, width, height);
    const GLenum format = wordOf(image.format);
    const int bits = bitsOf(image.format);
    if (image.isMaps())
      textures_[i] = device_.makeArray(format, size.width, size.height, static_cast<int>(image.layers), bits, bytes_);
    else if (isOwn(i))
      textures_[i] = device_.makeTexture(format, size.width, size.height, bits, bytes_);
  }
  bool complete = true;
  for (const PlannedPass& pass : plan_->passes)
    if (drawsToOwn(pass)) complete = makeFrame(pass, frame(pass)) && complete;
  return complete;
}

bool PlanTextures::makeFrame(const PlannedPass& pass, GLuint frame) const {
  GLenum buffers[kDrawBuffers];
  std::fill(std::begin(buffers), std::end(buffers), GLenum{GL_NONE});
  for (const pld_recipe_attachment& one : pass.attachments) {
    buffers[one.location] = GL_COLOR_ATTACHMENT0 + one.location;
    if (one.layer == PLD_LAYER_OF_FACE)
      device_.attachLayer(frame, buffers[one.location], texture(one.image), static_cast<int>(one.location));
    else
      device_.attach(frame, buffers[one.location], texture(one.image));
  }
  if (texture(pass.depthImage)) device_.attach(frame, GL_DEPTH_ATTACHMENT, texture(pass.depthImage));
  device_.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
  device_.gl.DrawBuffers(kDrawBuffers, buffers);
  return device_.isComplete();
}

GLuint PlanTextures::layersAt(int location) const {
  GLuint found = 0;  // lists are summed last
  for (const PlannedPass& pass : plan_->passes) {
    if (pass.stage != PLD_STAGE_LAYERS || (pass.moment != Moment::draws && pass.moment != Moment::end)) continue;
    for (const pld_recipe_attachment& one : pass.attachments)
      if (static_cast<int>(one.location) == location) found = texture(one.image);
  }
  return found;
}

bool PlanTextures::holds(GLuint texture) const {
  return texture && std::find(textures_.begin(), textures_.end(), texture) != textures_.end();
}

}  // namespace pellucid::c
