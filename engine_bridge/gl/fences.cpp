#include "engine_bridge/gl/fences.h"

namespace pellucid::gl {

Fences::~Fences() {
  if (held_.empty()) return;
  // The driver waits for the last one itself when it takes the context down.
  wait(oldest_ + held_.size() - 1);
  release();
}

void Fences::release() {
  glDeleteSync(held_.front().asked);
  glDeleteSync(held_.front().kept);
  held_.pop_front();
  ++oldest_;
}

Fences::Mark Fences::mark() {
  held_.push_back({glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0), glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)});
  const auto passed = [](GLsync sync) {
    GLint status = GL_UNSIGNALED;
    glGetSynciv(sync, GL_SYNC_STATUS, 1, nullptr, &status);
    return status == GL_SIGNALED;
  };
  while (held_.size() > 1 && passed(held_[1].asked)) release();
  return oldest_ + held_.size() - 1;
}

void Fences::wait(Mark mark) {
  if (mark < oldest_) return;
  constexpr GLuint64 kNanoseconds = 1000000000;
  const GLsync sync = held_[static_cast<std::size_t>(mark - oldest_)].asked;
  while (glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, kNanoseconds) == GL_TIMEOUT_EXPIRED) {
  }
  while (oldest_ < mark) release();
}

}  // namespace pellucid::gl
