// The exact tier: a stage's fragments are listed while the host draws, and summed when it ends.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine_bridge/c/glsl_text.h"
#include "engine_bridge/c/pass.h"

using namespace pellucid::c;

namespace {

constexpr uint64_t kMostFragments = uint64_t{1} << 31;  // as far as shaders/gl/exact_output.glsl counts
constexpr float kMostAPixel = 65536.0f;
static_assert(kListBlocks == kMostStorage);

}  // namespace

int pld_pass::listBlocks() const {
  const bool offsets = permutation_.scatters() || permutation_.rimsApart();
  return permutation_.has(PLD_FEATURE_DISPERSION) ? 5 : offsets ? 4 : 3;
}

Storage pld_pass::storageOf() const {
  if (!permutation_.exact()) return {};
  return {static_cast<int>(info_.storage_binding), listBlocks()};
}

pld_status pld_pass::checkLists(const pld_create_info& info) {
  if (!gl.ClearBufferSubData || !gl.GetBufferSubData || !gl.GetInteger64v || !gl.MemoryBarrier)
    return fail(PLD_ERROR_UNSUPPORTED, "pld_create: PLD_TIER_EXACT needs OpenGL 4.3: found %d.%d", gl.version / 10,
                gl.version % 10);
  if (!(info.fragments_per_pixel > 0.0f) || info.fragments_per_pixel > kMostAPixel)
    return fail(PLD_ERROR_ARGUMENT,
                "pld_create: fragments_per_pixel: found %g, expected more than 0 and at most %g in PLD_TIER_EXACT",
                static_cast<double>(info.fragments_per_pixel), static_cast<double>(kMostAPixel));
  GLint bindings = 0, blocks = 0, resources = 0;
  gl.GetIntegerv(GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES, &resources);
  gl.GetIntegerv(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, &bindings);
  gl.GetIntegerv(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, &blocks);
  if (blocks < listBlocks() || bindings < listBlocks())
    return fail(PLD_ERROR_UNSUPPORTED, "pld_create: found %d storage blocks for fragments, expected %d", blocks,
                listBlocks());
  // By what folds a stage; without scattering sums have an output for the nearest depth, plane or none.
  const std::size_t planes = planesOf(permutation_).size() + (permutation_.lean() || permutation_.scatters() ? 0u : 1u);
  const int written =
      listBlocks() + static_cast<int>(permutation_.low() ? std::max(planes, lowPlanes().size()) : planes);
  if (resources < written)
    return fail(PLD_ERROR_UNSUPPORTED, "pld_create: found %d blocks and outputs for a shader, expected %d", resources,
                written);
  if (info.storage_binding > static_cast<uint32_t>(bindings - listBlocks()))
    return fail(PLD_ERROR_ARGUMENT, "pld_create: storage_binding: found %u, expected at most %d", info.storage_binding,
                bindings - listBlocks());
  return PLD_OK;
}

std::string pld_pass::buildFolds() {
  std::string failure;
  const std::vector<std::string> places = storageDefines(static_cast<int>(info_.storage_binding));
  for (const pld_stage stage : {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW}) {
    if (!(stagesNeeded() & (1u << stage)) || !failure.empty()) continue;
    std::vector<std::string> defines = foldDefines(stage == PLD_STAGE_LOW ? lowPermutation() : permutation_, stage);
    defines.insert(defines.end(), places.begin(), places.end());
    failure =
        folds_[stage].build(gl, stage == PLD_STAGE_SOLIDS ? "gl/exact_solids.frag" : "gl/exact_fold.frag", defines);
  }
  return failure;
}

pld_status pld_pass::makeLists(int width, int height) {
  const auto pixels = static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  const double wanted = std::ceil(static_cast<double>(info_.fragments_per_pixel) * static_cast<double>(pixels));
  const auto room = static_cast<uint64_t>(wanted);
  const uint64_t linkBytes = 4 * (1 + pixels + room), recordBytes = 16 * room;
  GLint64 most = 0;
  gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  const uint64_t largest = linkBytes > recordBytes ? linkBytes : recordBytes;
  if (room > kMostFragments || largest > static_cast<uint64_t>(most))
    return fail(PLD_ERROR_MEMORY,
                "pld_resize: fragments_per_pixel %g of %dx%d: found a storage block of %llu bytes, this device has at "
                "most %lld",
                static_cast<double>(info_.fragments_per_pixel), width, height, static_cast<unsigned long long>(largest),
                static_cast<long long>(most));
  gl.GenBuffers(listBlocks(), lists_);
  for (int i = 0; i < listBlocks(); ++i) {
    const uint64_t bytes = i == 0 ? linkBytes : recordBytes;
    gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, lists_[i]);
    gl.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_COPY);
    bytes_ += bytes;
  }
  room_ = room;
  return PLD_OK;
}

void pld_pass::bindLists() {
  // The first one last: it stays at the target too.
  for (int i = listBlocks() - 1; i >= 0; --i)
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, info_.storage_binding + static_cast<GLuint>(i), lists_[i]);
}

void pld_pass::releaseLists() {
  for (GLuint& one : lists_) {
    if (one) gl.DeleteBuffers(1, &one);
    one = 0;
  }
  room_ = fragments_ = 0;
}

// Empty lists, and nothing but them to draw to.
void pld_pass::openLists() {
  bindLists();
  const auto heads = static_cast<GLsizeiptr>(4 * (1 + static_cast<uint64_t>(width_) * static_cast<uint64_t>(height_)));
  gl.ClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, heads, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  for (GLuint i = 0; i < kDrawBuffers; ++i) gl.ColorMaski(i, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
}

// The stage's planes from its lists; refuses those that are not whole.
pld_status pld_pass::foldLists() {
  const bool low = stage_ == PLD_STAGE_LOW;
  setPlainDrawing(gl, frame_.width / (low ? frame_.low_factor : 1), frame_.height / (low ? frame_.low_factor : 1));
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frameOf(stage_));
  bindLists();  // the host may have put others there meanwhile
  gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  const Program& fold = folds_[stage_];
  useProgram(fold);
  gl.Uniform1i(fold.place(gl, "rowLength"), width_);
  gl.Uniform4f(fold.place(gl, "weight"), frame_.weight_near, frame_.weight_far, frame_.weight_exponent, 0.0f);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  GLuint came = 0;
  gl.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof(came), &came);
  if (came > fragments_) fragments_ = came;
  if (came <= room_) return PLD_OK;
  const double pixels = static_cast<double>(width_) * static_cast<double>(height_);
  return fail(PLD_ERROR_MEMORY,
              "pld_end: %u fragments came, %llu fit: fragments_per_pixel is %g, expected %.2f, or less geometry", came,
              static_cast<unsigned long long>(room_), static_cast<double>(info_.fragments_per_pixel),
              std::ceil(100.0 * static_cast<double>(came) / pixels) / 100.0);
}
