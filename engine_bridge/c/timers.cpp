#include "engine_bridge/c/timers.h"

namespace pellucid::c {

void Timers::create(const GlFunctions& gl) {
  for (auto& frame : queries_) gl.GenQueries(kMarks, frame);
  for (auto& face : faces_) gl.GenQueries(2, face);
}

void Timers::destroy(const GlFunctions& gl) {
  if (on()) {
    for (auto& frame : queries_) gl.DeleteQueries(kMarks, frame);
    for (auto& face : faces_) gl.DeleteQueries(2, face);
  }
  *this = {};
}

void Timers::nextFrame() {
  now_ = (now_ + 1) % kFrames;
  written_[now_] = 0;
}

void Timers::mark(const GlFunctions& gl, int mark) {
  if (!on()) return;
  gl.QueryCounter(queries_[now_][mark], GL_TIMESTAMP);
  written_[now_] |= 1u << mark;
}

bool Timers::read(const GlFunctions& gl, pld_value what, uint64_t& nanoseconds) const {
  for (int back = 0; back < kFrames; ++back) {
    const int frame = (now_ + kFrames - back) % kFrames;
    if (!(written_[frame] & (1u << kResolved))) continue;
    GLint there = 0;
    gl.GetQueryObjectiv(queries_[frame][kResolved], GL_QUERY_RESULT_AVAILABLE, &there);
    if (!there) continue;
    const auto between = [&](int first, int last) -> uint64_t {
      if (!(written_[frame] & (1u << first)) || !(written_[frame] & (1u << last))) return 0;
      GLuint64 from = 0, to = 0;
      gl.GetQueryObjectui64v(queries_[frame][first], GL_QUERY_RESULT, &from);
      gl.GetQueryObjectui64v(queries_[frame][last], GL_QUERY_RESULT, &to);
      return to > from ? to - from : 0;
    };
    nanoseconds = 0;
    if (what == PLD_VALUE_NS_RESOLVE) nanoseconds = between(kResolve, kResolved);
    for (const pld_stage stage : {PLD_STAGE_SOLIDS, PLD_STAGE_FRONT, PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW}) {
      if (what == PLD_VALUE_NS_BEGIN) nanoseconds += between(markOf(stage, 0), markOf(stage, 1));
      if (what == PLD_VALUE_NS_DRAWS) nanoseconds += between(markOf(stage, 1), markOf(stage, 2));
    }
    return true;
  }
  return false;
}

void Timers::beginFace(const GlFunctions& gl) {
  if (!on()) return;
  face_ = (face_ + 1) % kFrames;
  faceDrawn_[face_] = false;
  gl.QueryCounter(faces_[face_][0], GL_TIMESTAMP);
}

void Timers::endFace(const GlFunctions& gl) {
  if (!on()) return;
  gl.QueryCounter(faces_[face_][1], GL_TIMESTAMP);
  faceDrawn_[face_] = true;
}

bool Timers::readFace(const GlFunctions& gl, uint64_t& nanoseconds) const {
  for (int back = 0; back < kFrames; ++back) {
    const int face = (face_ + kFrames - back) % kFrames;
    if (!faceDrawn_[face]) continue;
    GLint there = 0;
    gl.GetQueryObjectiv(faces_[face][1], GL_QUERY_RESULT_AVAILABLE, &there);
    if (!there) continue;
    GLuint64 from = 0, to = 0;
    gl.GetQueryObjectui64v(faces_[face][0], GL_QUERY_RESULT, &from);
    gl.GetQueryObjectui64v(faces_[face][1], GL_QUERY_RESULT, &to);
    nanoseconds = to > from ? to - from : 0;
    return true;
  }
  return false;
}

}  // namespace pellucid::c
