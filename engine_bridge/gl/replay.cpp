// The parity test's GL voice: fragments read from a buffer instead of rasterised, through the same blending.
#include <algorithm>
#include <limits>

#include "engine_bridge/gl/fences.h"
#include "engine_bridge/gl/frame_blocks.h"
#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/plane_targets.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "gbuffer/errors.h"
#include "shaders/plane_defines.h"

namespace pellucid {

namespace {

template <class Values>
void fill(const gl::Buffer& buffer, const Values& values) {
  glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(),
                    GL_STATIC_DRAW);
}

gl::FrameBlock frameOf(const shading::WeightSettings& weight, int width) {
  gl::FrameBlock frame;
  frame.weightNear = weight.rangeNear;
  frame.weightFar = weight.rangeFar;
  frame.weightExponent = weight.exponent;
  frame.weightReference = weight.reference;
  frame.bandWidth = width;
  return frame;
}

}  // namespace

OitPlanes replayFragments(GlContext&, const FragmentLists& lists, const shading::WeightSettings& weight,
                          int normalisation) {
  const int width = lists.window.width(), height = lists.window.height();
  OitPlanes planes = emptyPlanes(lists.window, lists.window);
  planes.info.weight = weight;
  planes.info.normalisation = normalisation;
  planes.solid = lists.solid;
  if (lists.fragments.empty()) return planes;
  if (lists.fragments.size() > std::numeric_limits<std::uint32_t>::max())
    throw ResourceError("GL: too many fragments to replay at once");

  std::vector<std::uint32_t> offsets(lists.offsets.begin(), lists.offsets.end());
  std::uint32_t deepest = 0;
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) deepest = std::max(deepest, offsets[i + 1] - offsets[i]);

  const gl::FrameBlock frame = frameOf(weight, width);
  const gl::Buffer fragmentBuffer = gl::Buffer::make(), offsetBuffer = gl::Buffer::make(),
                   frameBuffer = gl::Buffer::make();
  fill(fragmentBuffer, lists.fragments);
  fill(offsetBuffer, offsets);
  glNamedBufferData(frameBuffer.name(), sizeof(frame), &frame, GL_STATIC_DRAW);
  gl::checkGl("uploading fragments to replay");

  addPlanes(planes, modelOf(lists));
  std::vector<gl::Buffer> columnBuffers;
  for (std::size_t k = 0; k < kFragmentColumns; ++k) {
    columnBuffers.push_back(gl::Buffer::make());
    if (lists.columns()[k]->empty()) continue;
    fill(columnBuffers[k], *lists.columns()[k]);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, gl::kFirstColumn + static_cast<GLuint>(k), columnBuffers[k].name());
  }
  const gl::Program program = gl::buildProgram("gl/fullscreen.vert", "gl/replay.frag", writeDefines(modelOf(planes)));
  const gl::VertexArray noVertices = gl::VertexArray::make();
  gl::PlaneTargets targets(width, height);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glViewport(0, 0, width, height);
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  targets.begin(planesOf(modelOf(planes)));
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frameBuffer.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, fragmentBuffer.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, offsetBuffer.name());
  glBindVertexArray(noVertices.name());
  glUseProgram(program.name.name());
  for (std::uint32_t turn = 0; turn < deepest; ++turn) {
    glUniform1ui(program.turn, turn);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  gl::fences().mark();
  targets.read(planes, 0, 0);
  glUseProgram(0);
  return planes;
}

}  // namespace pellucid
