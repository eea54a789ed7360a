// Times on the device, a few frames late so that nothing waits.
#pragma once
#include "engine_bridge/c/gl_functions.h"

namespace pellucid::c {

class Timers {
 public:
  static constexpr int kMarks = 17;  // three a stage: begin, begun, end; then resolve, resolved
  static constexpr int kFrames = 4;

  void create(const GlFunctions& gl);
  void destroy(const GlFunctions& gl);
  bool on() const { return queries_[0][0] != 0; }

  void nextFrame();
  void mark(const GlFunctions& gl, int mark);
  static int markOf(pld_stage stage, int part) { return 3 * static_cast<int>(stage) + part; }
  // Faces of shadow maps, of which a frame may have any number.
  void beginFace(const GlFunctions& gl);
  void endFace(const GlFunctions& gl);
  // Of the newest face that is known; false when none is.
  bool readFace(const GlFunctions& gl, uint64_t& nanoseconds) const;
  static constexpr int kResolve = 15, kResolved = 16;

  // Sum over stages of the time between two parts of a stage, or of the resolve; false when no frame is known yet.
  bool read(const GlFunctions& gl, pld_value what, uint64_t& nanoseconds) const;

 private:
  GLuint queries_[kFrames][kMarks] = {};
  uint32_t written_[kFrames] = {};
  GLuint faces_[kFrames][2] = {};
  bool faceDrawn_[kFrames] = {};
  int face_ = 0;
  int now_ = 0;
};

}  // namespace pellucid::c
