#include "engine_bridge/c/fragment_room.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine_bridge/c/glsl_text.h"

namespace pellucid::c {
namespace {

constexpr float kMostAPixel = 65536.0f;
static_assert(kListBlocks == kMostStorage);

// The most that a pass with lists draws to.
std::size_t outputsOf(const RecipePlan& plan) {
  std::size_t most = 0;
  for (const PlannedPass& pass : plan.passes)
    if (pass.lists > 0) most = std::max(most, pass.attachments.size());
  return most;
}

}  // namespace

Storage FragmentRoom::storage() const {
  if (!device_.permutation.exact()) return {};
  return {static_cast<int>(device_.info.storage_binding), listBlocks(device_.permutation)};
}

pld_status FragmentRoom::check() const {
  const Permutation& p = device_.permutation;
  const pld_create_info& info = device_.info;
  const GlFunctions& gl = device_.gl;
  if (!p.exact()) return PLD_OK;
  if (!gl.ClearBufferSubData || !gl.GetBufferSubData || !gl.GetInteger64v || !gl.MemoryBarrier)
    return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_create: PLD_TIER_EXACT needs OpenGL 4.3: found %d.%d",
                        gl.version / 10, gl.version % 10);
  if (!(info.fragments_per_pixel > 0.0f) || info.fragments_per_pixel > kMostAPixel)
    return device_.fail(
        PLD_ERROR_ARGUMENT,
        "pld_create: fragments_per_pixel: found %g, expected more than 0 and at most %g in PLD_TIER_EXACT",
        static_cast<double>(info.fragments_per_pixel), static_cast<double>(kMostAPixel));
  GLint bindings = 0, found = 0, resources = 0;
  gl.GetIntegerv(GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES, &resources);
  gl.GetIntegerv(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, &bindings);
  gl.GetIntegerv(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, &found);
  const int blocks = listBlocks(p), written = blocks + static_cast<int>(outputsOf(plan_));
  if (found < blocks || bindings < blocks)
    return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_create: found %d storage blocks for fragments, expected %d", found,
                        blocks);
  if (resources < written)
    return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_create: found %d blocks and outputs for a shader, expected %d",
                        resources, written);
  if (info.storage_binding > static_cast<uint32_t>(bindings - blocks))
    return device_.fail(PLD_ERROR_ARGUMENT, "pld_create: storage_binding: found %u, expected at most %d",
                        info.storage_binding, bindings - blocks);
  return PLD_OK;
}

pld_status FragmentRoom::make(int width, int height) {
  if (!device_.permutation.exact()) return PLD_OK;
  const GlFunctions& gl = device_.gl;
  const double wanted = static_cast<double>(device_.info.fragments_per_pixel);
  const auto pixels = static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  const auto room = static_cast<uint64_t>(std::ceil(wanted * static_cast<double>(pixels)));
  const ListSizes sizes = listSizes(width, height, room);
  GLint64 most = 0;
  gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  const uint64_t largest = std::max(sizes.links, sizes.record);
  if (room > kMostFragments || largest > static_cast<uint64_t>(most))
    return device_.fail(
        PLD_ERROR_MEMORY,
        "pld_resize: fragments_per_pixel %g of %dx%d: found a storage block of %llu bytes, this device has at "
        "most %lld",
        wanted, width, height, static_cast<unsigned long long>(largest), static_cast<long long>(most));
  const int blocks = listBlocks(device_.permutation);
  gl.GenBuffers(blocks, lists_);
  for (int i = 0; i < blocks; ++i) {
    const uint64_t bytes = i == 0 ? sizes.links : sizes.record;
    gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, lists_[i]);
    gl.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_COPY);
    bytes_ += bytes;
  }
  room_ = room;
  width_ = width;
  height_ = height;
  return PLD_OK;
}

void FragmentRoom::release() {
  for (GLuint& one : lists_) {
    if (one) device_.gl.DeleteBuffers(1, &one);
    one = 0;
  }
  room_ = fragments_ = bytes_ = 0;
}

void FragmentRoom::bind() const {
  // The first one last: it stays at the target too.
  for (int i = listBlocks(device_.permutation) - 1; i >= 0; --i)
    device_.gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, device_.info.storage_binding + static_cast<GLuint>(i),
                              lists_[i]);
}

void FragmentRoom::open() const {
  const GlFunctions& gl = device_.gl;
  bind();
  const auto heads = static_cast<GLsizeiptr>(listSizes(width_, height_, room_).heads);
  gl.ClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, heads, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  device_.allowColours(0, false);
}

void FragmentRoom::show() const {
  bind();  // the host may have put others there meanwhile
  device_.gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

pld_status FragmentRoom::count() {
  GLuint came = 0;
  device_.gl.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof(came), &came);
  fragments_ = std::max<uint64_t>(fragments_, came);
  if (came <= room_) return PLD_OK;
  const double pixels = static_cast<double>(width_) * static_cast<double>(height_);
  return device_.fail(
      PLD_ERROR_MEMORY,
      "pld_end: %u fragments came, %llu fit: fragments_per_pixel is %g, expected %.2f, or less geometry", came,
      static_cast<unsigned long long>(room_), static_cast<double>(device_.info.fragments_per_pixel),
      std::ceil(100.0 * static_cast<double>(came) / pixels) / 100.0);
}

}  // namespace pellucid::c
