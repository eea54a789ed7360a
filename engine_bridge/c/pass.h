// One view's planes and the calls that work on them. What crosses the C boundary is pass_calls.cpp's.
#pragma once
#include <atomic>
#include <string>
#include <vector>

#include "engine_bridge/c/permutation.h"
#include "engine_bridge/c/programs.h"
#include "engine_bridge/c/saved_state.h"
#include "engine_bridge/c/timers.h"

struct pld_pass {
  std::atomic_flag busy = ATOMIC_FLAG_INIT;
  char message[512] = {};

  // Each leaves GL as it was unless it returns PLD_OK, and begin() until end().
  pld_status create(const pld_create_info& info);
  pld_status resize(int width, int height);
  pld_status fix(const pld_frame& frame, uint32_t fields);
  pld_status begin(pld_stage stage, const pld_frame& frame);
  pld_status end();
  pld_status resolve(const pld_target& target);
  pld_status query(pld_value what, uint64_t& value);
  pld_status seam(pld_stage stage, int version, const char*& text);
  pld_status connect(GLuint program);
  pld_status shadowResize(const pld_shadow_info* info);
  pld_status shadowBegin(const pld_shadow_view& view);
  pld_status shadowEnd();
  pld_status shadowText(pld_shadow_text which, int version, const char*& text);
  void destroyObjects();

  bool isCurrent() const;
  // Says why, to the message and to the log.
  [[gnu::format(printf, 3, 4)]] pld_status fail(pld_status status, const char* format, ...);
  void say(pld_log_level level, const char* text) const;

 private:
  static constexpr int kLevels = 25, kSpreadPlanes = 5, kStages = 5, kRimPlanes = 3, kLowTexels = 3;
  static constexpr int kMostFaces = 96;
  enum class FaceKind : uint8_t { empty, directional, local };  // of a shadow map, as it was drawn
  enum class Step { sizeless, between, open, drawn };           // of a frame; drawn: a stage ended, no resolve yet

  struct Plane {
    pellucid::c::PlaneSpec spec;
    GLuint texture = 0;
  };

  pld_status checkFrame(const pld_frame& frame, bool isFirst, GLenum& depthAttachment);
  pld_status checkNumbers(const char* call, const pld_frame& frame, uint32_t fields);
  const char* changedField(const pld_frame& frame) const;
  pld_status checkOrder(pld_stage stage);
  pld_status checkGlsl(const char* call, int version);
  pld_status checkShadowInfo(const pld_shadow_info& info);
  pld_status checkShadowView(const pld_shadow_view& view, GLenum& depthAttachment);
  pld_status makeShadows();
  void setShadowTable(const pld_shadow_view& view);
  void filterShadow(int face);
  void releaseShadows();
  bool shadowIsFiltered() const;
  int shadowEdge() const;  // as looked up
  int shadowChannels() const { return shadowInfo_.coloured ? 3 : 1; }
  void setFrame(const pld_frame& frame, int pixelsATexel);
  void drawPlanarDepth(const pld_frame& frame);
  void drawEmptyPlanes(const pld_frame& frame);
  void openStage(pld_stage stage, GLuint occlusion);
  void clearStage(pld_stage stage);
  void drawPyramid();
  pld_status checkLists(const pld_create_info& info);
  std::string buildFolds();
  pld_status makeLists(int width, int height);
  void releaseLists();
  void openLists();
  void bindLists();
  pld_status foldLists();
  int listBlocks() const;
  pellucid::c::Storage storageOf() const;  // bindings that stages take
  pld_status darkenRims();
  GLuint frameOf(pld_stage stage) const;
  void blend(GLuint attachment, pellucid::c::BlendKind kind);
  pellucid::c::Permutation lowPermutation() const;
  std::vector<pellucid::c::PlaneSpec> lowPlanes() const;
  std::string buildLowPrograms();
  bool makeLowTextures(int width, int height);
  void drawLowDepth(const pld_frame& frame);
  void addLow();
  static bool isOfShadows(pld_view view);
  static bool isOfRims(pld_view view);
  static bool isOfLow(pld_view view);
  static bool isOfParts(pld_view view);  // of rims or of layers of low resolution
  std::string buildViewPrograms();
  pld_status checkView(const pld_target& target);
  pld_status checkTarget(const pld_target& target, int width, int height, GLuint source);
  GLuint targetFrame(const pld_target& target) const;
  pld_status bindTarget(const pld_target& target, GLuint source);
  void unbindTarget(const pld_target& target);
  void drawPart(pld_view view);
  pld_status resolveShadow(const pld_target& target);
  void bind(GLuint unit, GLuint texture);
  void useProgram(const pellucid::c::Program& program);
  GLuint makeTexture(GLenum format, int width, int height, int bits);
  pld_status makeTextures(int width, int height);
  void layOutPyramid(int width, int height);
  void releaseTextures();
  pld_status makePrograms();
  pellucid::c::Units unitsOf() const;
  uint32_t stagesNeeded() const;
  void pushGroup(const char* name);
  void popGroup();

  pellucid::c::GlFunctions gl;
  pld_create_info info_{};
  pellucid::c::Permutation permutation_;
  pellucid::c::SavedState saved_;
  pellucid::c::Timers timers_;
  pellucid::c::Program emptyPlanes_, planarDepth_, picture_, view_, spreadLevel_, rimsApply_, lowDepth_, lowTexel_,
      upsample_, viewRims_, viewLow_;
  GLuint vertexArray_ = 0, sampler_ = 0, uniforms_ = 0;
  GLuint lowFrame_ = 0, lowDepthFrame_ = 0, lowTexelFrame_ = 0, lowOverFrame_ = 0, rimsFrame_ = 0, layersFrame_ = 0,
         frontFrame_ = 0, solidFrame_ = 0, planarFrame_ = 0, spreadFrame_ = 0, targetFrame_ = 0;
  std::vector<Plane> planes_, low_;  // of the layers, of those of low resolution
  GLuint planarZ_ = 0, frontZ_ = 0, solid_ = 0, solidDepth_ = 0, spread_[kSpreadPlanes] = {}, rims_[kRimPlanes] = {},
         lowFarZ_ = 0, lowTexels_[kLowTexels] = {}, lowOver_[2] = {};
  GLint levels_[kLevels][4] = {};
  int levelCount_ = 0, atlasWidth_ = 0, atlasHeight_ = 0;
  // Exact tier: blocks of shaders/gl/exact_lists.glsl, what each stage's are folded by, and fragments of the newest
  // frame.
  GLuint lists_[pellucid::c::kMostStorage] = {};
  pellucid::c::Program folds_[kStages];
  uint64_t room_ = 0, fragments_ = 0;
  uint64_t bytes_ = 0;
  int width_ = 0, height_ = 0;
  char label_[64] = {};
  std::string seams_[kStages];

  // Shadow maps: as drawn, between the two filters, and as they are looked up.
  pld_shadow_info shadowInfo_{};
  pellucid::c::Program shadowTexels_, shadowDown_, viewShadow_;
  GLuint shadowDrawn_[2] = {}, shadowAcross_[3] = {}, shadowMaps_ = 0, shadowTable_ = 0, shadowUniforms_ = 0;
  GLuint casterFrame_ = 0, acrossFrame_ = 0, mapFrame_ = 0;
  uint64_t shadowBytes_ = 0;
  bool shadowOpen_ = false;
  FaceKind shadowFaces_[kMostFaces] = {};
  pld_shadow_view shadowView_{};
  double shadowRows_ = 1.0;  // -1: NDC's y runs against the rows
  GLenum shadowDepthAttachment_ = 0;
  std::string shadowTexts_[2];

  Step step_ = Step::sizeless;
  pld_stage stage_ = PLD_STAGE_LAYERS;
  uint32_t stagesDone_ = 0;
  pld_frame frame_{};
  GLenum frameDepthAttachment_ = 0;
};
