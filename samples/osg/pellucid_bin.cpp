#include "samples/osg/pellucid_bin.h"

#include <EGL/egl.h>

#include <osg/BlendFunc>
#include <osg/Camera>
#include <osg/Depth>
#include <osg/FrameBufferObject>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <cstdio>
#include <stdexcept>

namespace pellucid::osgsample {
namespace {

// Attributes that leave GL as it is: between pld_begin() and pld_end() blending and the depth test are Pellucid's.
class KeptBlending : public osg::BlendFunc {
 public:
  void apply(osg::State&) const override {}
};
class KeptDepth : public osg::Depth {
 public:
  void apply(osg::State&) const override {}
};

// OpenSceneGraph remembers what it has set last, and pld_end() puts back what pld_begin() found: so that both agree,
// the state of the top of the graph is set before either.
void applyTop(osg::State& state, osgUtil::RenderLeaf*& previous) {
  if (previous) osgUtil::StateGraph::moveToRootStateGraph(state, previous->_parent);
  previous = nullptr;
  state.apply();
}

const osg::Texture* attached(const osgUtil::RenderStage* stage, osg::Camera::BufferComponent which) {
  const auto& attachments = stage->getCamera()->getBufferAttachmentMap();
  const auto found = attachments.find(which);
  if (found == attachments.end() || !found->second._texture) throw std::runtime_error("the camera draws to no texture");
  return found->second._texture.get();
}

GLuint nameOf(const osg::Texture* texture, const osg::State& state) {
  return texture->getTextureObject(state.getContextID())->id();
}

const osgUtil::RenderLeaf* anyLeaf(const osgUtil::RenderBin* bin) {
  if (!bin->getRenderLeafList().empty()) return bin->getRenderLeafList().front();
  for (const osgUtil::StateGraph* graph : bin->getStateGraphList())
    if (!graph->_leaves.empty()) return graph->_leaves.front().get();
  return nullptr;
}

}  // namespace

void PellucidBin::check(pld_status status) const {
  if (status != PLD_OK) throw std::runtime_error(std::string(pld_status_name(status)) + ": " + pld_message(pass_));
}

void PellucidBin::create(osg::State& state, int width, int height) {
  pld_create_info info{};
  info.struct_size = sizeof(info);
  info.version = PLD_VERSION;
  info.get_proc_address = [](void*, const char* name) { return reinterpret_cast<pld_proc>(eglGetProcAddress(name)); };
  info.log = [](void*, pld_log_level, const char* text) { std::fprintf(stderr, "%s\n", text); };
  info.method = settings_.method;
  info.features = settings_.features;
  info.depth = PLD_DEPTH_DEVICE;
  info.clip = PLD_CLIP_MINUS_ONE_TO_ONE;
  info.uniform_binding = 3;
  info.texture_unit = 8;
  if (pld_create(&info, &pass_) != PLD_OK) throw std::runtime_error("no pass");
  check(pld_resize(pass_, width, height));
  for (const pld_stage stage : {PLD_STAGE_FRONT, PLD_STAGE_LAYERS}) {
    if (stage == PLD_STAGE_FRONT && settings_.method != PLD_METHOD_FRONT_TAIL) continue;
    const char* seam = nullptr;
    check(pld_glsl(pass_, stage, 330, &seam));
    Stage one{stage, new osg::Program, new osg::StateSet};
    one.program->addShader(new osg::Shader(osg::Shader::VERTEX, settings_.vertex));
    one.program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                           "#version 330 compatibility\n" + std::string(seam) + settings_.fragment));
    one.program->compileGLObjects(state);
    check(pld_connect(pass_, one.program->getPCP(state)->getHandle()));
    constexpr auto always = osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE;
    one.state->setAttribute(one.program, always);
    one.state->setAttribute(new KeptBlending, always);
    one.state->setAttribute(new KeptDepth, always);
    one.state->setMode(GL_BLEND, always);
    stages_.push_back(one);
  }
  picture_ = new osg::Texture2D;
  picture_->setTextureSize(width, height);
  picture_->setInternalFormat(GL_RGBA32F_ARB);
  picture_->setSourceFormat(GL_RGBA);
  picture_->setSourceType(GL_FLOAT);
  picture_->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
  state.setActiveTextureUnit(0);
  picture_->apply(state);
  state.haveAppliedTextureAttribute(0, picture_);
  auto* gl = state.get<osg::GLExtensions>();
  GLint read = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read);
  gl->glGenFramebuffers(1, &pictureFrame_);
  gl->glBindFramebuffer(GL_READ_FRAMEBUFFER, pictureFrame_);
  gl->glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, nameOf(picture_, state), 0);
  gl->glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read));
  width_ = width;
  height_ = height;
}

void PellucidBin::drawImplementation(osgUtil::RenderBin* bin, osg::RenderInfo& info, osgUtil::RenderLeaf*& previous) {
  osg::State& state = *info.getState();
  const osgUtil::RenderLeaf* leaf = anyLeaf(bin);
  if (!leaf) return;
  const osg::Texture* colour = attached(bin->getStage(), osg::Camera::COLOR_BUFFER);
  const int width = colour->getTextureWidth(), height = colour->getTextureHeight();
  if (!pass_) create(state, width, height);
  if (width != width_ || height != height_) throw std::runtime_error("this sample's pictures keep their size");

  pld_frame frame{};
  frame.struct_size = sizeof(frame);
  frame.colour_texture = nameOf(colour, state);
  frame.depth_texture = nameOf(attached(bin->getStage(), osg::Camera::DEPTH_BUFFER), state);
  frame.width = width;
  frame.height = height;
  for (int i = 0; i < 16; ++i) frame.projection[i] = static_cast<float>(leaf->_projection->ptr()[i]);
  frame.metres_per_unit = frame.pre_exposure = 1.0f;
  frame.weight_near = 0.1f;
  frame.weight_far = 100.0f;
  frame.refract = PLD_REFRACT_AT_DEPTH;
  frame.refract_distance = 1.0f;
  frame.diffusion_k0 = 0.3f;
  frame.diffusion_k1 = 0.5f;
  for (const Stage& stage : stages_) {
    bin->setStateSet(stage.state);
    applyTop(state, previous);
    check(pld_begin(pass_, stage.stage, &frame));
    bin->drawImplementation(info, previous);
    applyTop(state, previous);
    check(pld_end(pass_));
  }
  // The picture goes beside the camera's, which is read meanwhile, and from there into its place.
  pld_target target{};
  target.struct_size = sizeof(target);
  target.kind = PLD_TARGET_TEXTURE;
  target.name = nameOf(picture_, state);
  check(pld_resolve(pass_, &target));
  auto* gl = state.get<osg::GLExtensions>();
  GLint read = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read);
  gl->glBindFramebuffer(GL_READ_FRAMEBUFFER, pictureFrame_);
  gl->glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl->glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read));
}

void PellucidBin::release(osg::State& state) {
  if (!pass_) return;
  check(pld_destroy(&pass_));
  state.get<osg::GLExtensions>()->glDeleteFramebuffers(1, &pictureFrame_);
  stages_.clear();
}

}  // namespace pellucid::osgsample
