// The shared occlusion text gives GL the bits that it gives C++.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "engine_bridge/gl/transparent_pass.h"
#include "gbuffer/errors.h"
#include "shaders/shader_source.h"
#include "shaders/shading.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

constexpr int kEdge = 64;

struct Cell {
  glm::vec2 gradient;  // of the rim's coverage
  float rimZ, opaqueZ, open, spare[3];
};

const char* const kMain = R"(
struct Cell { vec2 gradient; float rimZ; float opaqueZ; float open; float a; float b; float c; };
layout(std430, binding = 0) readonly buffer Cells { Cell cells[]; };
layout(std430, binding = 1) writeonly buffer Results { float results[]; };
layout(local_size_x = 64) in;
void main() {
  int i = int(gl_GlobalInvocationID.x);
  ivec2 pixel = ivec2(i % EDGE, i / EDGE);
  OcclusionSearch search = occlusionSearch(cells[i].gradient);
  precise vec2 sum = vec2(0.0f);
  for (int tap = 0; tap < search.taps; ++tap) {
    ivec2 at = occlusionPixel(pixel, search, tap, FORM, ivec2(EDGE));
    Cell cell = cells[at.y * EDGE + at.x];
    sum = sum + occlusionTap(search, tap, cell.open, cell.opaqueZ, cells[i].rimZ, FORM);
  }
  float occlusion = occlusionFrom(sum, FORM);
  results[i] = occludedLight(vec3(0.3f), vec3(0.7f), occlusion, 0.25f).x;
}
)";

std::vector<Cell> randomCells() {
  test::Random random(11);
  std::vector<Cell> cells(kEdge * kEdge);
  for (Cell& cell : cells) {
    cell = {};
    const bool flat = random.below(8) == 0;  // searches a box
    cell.gradient = flat ? glm::vec2(0.0f) : glm::vec2(random.uniformf() - 0.5f, random.uniformf() - 0.5f);
    cell.rimZ = static_cast<float>(random.between(0.5, 20.0));
    cell.opaqueZ = random.below(5) == 0 ? INFINITY : cell.rimZ * (0.95f + 0.2f * random.uniformf());
    cell.open = random.uniformf();
  }
  return cells;
}

float onCpu(const std::vector<Cell>& cells, int i, int form) {
  using namespace shading;
  const Cell& here = cells[static_cast<std::size_t>(i)];
  const OcclusionSearch search = occlusionSearch(here.gradient);
  glm::vec2 sum(0.0f);
  for (int tap = 0; tap < search.taps; ++tap) {
    const glm::ivec2 at = occlusionPixel({i % kEdge, i / kEdge}, search, tap, form, glm::ivec2(kEdge));
    const Cell& cell = cells[static_cast<std::size_t>(at.y * kEdge + at.x)];
    sum += occlusionTap(search, tap, cell.open, cell.opaqueZ, here.rimZ, form);
  }
  return occludedLight(glm::vec3(0.3f), glm::vec3(0.7f), occlusionFrom(sum, form), 0.25f).x;
}

TEST(OcclusionParity, GlGivesTheSameBits) {
  const GlContext context;
  const std::vector<Cell> cells = randomCells();
  for (const int form : {shading::PLD_OCCLUSION_RELATIVE, shading::PLD_OCCLUSION_PUBLISHED}) {
    const std::string source =
        shaderSource("shared/occlusion.glsl", {"EDGE " + std::to_string(kEdge), "FORM " + std::to_string(form)}) +
        kMain;
    const char* text = source.c_str();
    const GLuint program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    char log[2048] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    ASSERT_TRUE(linked) << log;
    GLuint buffers[2];
    glCreateBuffers(2, buffers);
    glNamedBufferStorage(buffers[0], static_cast<GLsizeiptr>(cells.size() * sizeof(Cell)), cells.data(), 0);
    glNamedBufferStorage(buffers[1], static_cast<GLsizeiptr>(cells.size() * sizeof(float)), nullptr, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[0]);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffers[1]);
    glUseProgram(program);
    glDispatchCompute(kEdge * kEdge / 64, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<float> results(cells.size());
    glGetNamedBufferSubData(buffers[1], 0, static_cast<GLsizeiptr>(results.size() * sizeof(float)), results.data());
    glDeleteBuffers(2, buffers);
    glDeleteProgram(program);
    int differ = 0, dark = 0;
    for (int i = 0; i < kEdge * kEdge; ++i) {
      const float cpu = onCpu(cells, i, form), gl = results[static_cast<std::size_t>(i)];
      differ += std::memcmp(&cpu, &gl, sizeof cpu) != 0;
      dark += cpu < 0.9f;
    }
    printf("[ figure ] form %d: %d of %d values differ between CPU and GL\n", form, differ, kEdge * kEdge);
    EXPECT_EQ(differ, 0);
    EXPECT_GT(dark, kEdge * kEdge / 8);  // something was inferred at all
  }
}

}  // namespace
}  // namespace pellucid
