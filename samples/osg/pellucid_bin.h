// OpenSceneGraph's bin of transparent things, drawn by Pellucid: through its C header alone.
#pragma once
#include <pellucid/pellucid.h>
#include <osg/Program>
#include <osg/StateSet>
#include <osg/Texture2D>
#include <osgUtil/RenderBin>

#include <string>
#include <utility>
#include <vector>

namespace pellucid::osgsample {

struct BinSettings {
  pld_method method = PLD_METHOD_PHENOMENOLOGICAL;
  uint32_t features = 0;
  std::string vertex;    // GLSL of the host's transparent materials, whole
  std::string fragment;  // the same without #version; calls pldWriteFragment()
};

// The callback of a render bin. Its drawables keep the programs and the blending that they have; the bin's own state
// overrides both. Works on cameras that draw to a framebuffer object with a colour and a depth texture.
class PellucidBin : public osgUtil::RenderBin::DrawCallback {
 public:
  explicit PellucidBin(BinSettings settings) : settings_(std::move(settings)) {}
  void drawImplementation(osgUtil::RenderBin* bin, osg::RenderInfo& info, osgUtil::RenderLeaf*& previous) override;
  void release(osg::State& state);  // with the context current

 private:
  struct Stage {
    pld_stage stage;
    osg::ref_ptr<osg::Program> program;
    osg::ref_ptr<osg::StateSet> state;
  };
  void create(osg::State& state, int width, int height);
  void check(pld_status status) const;

  BinSettings settings_;
  pld_pass* pass_ = nullptr;
  std::vector<Stage> stages_;
  osg::ref_ptr<osg::Texture2D> picture_;
  GLuint pictureFrame_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace pellucid::osgsample
