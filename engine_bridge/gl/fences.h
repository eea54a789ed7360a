// Places in a context's work, in order: to wait for them, and for the sake of a driver that frees its own too early.
#pragma once
#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <deque>

namespace pellucid::gl {

// Whoever draws ends with mark(). llvmpipe of Mesa 22.3.6 needs it: lp_setup.c reads without a lock that all threads
// have counted the fence of a scene, and frees the fence while the last of them still holds its mutex (lp_fence.c);
// what that thread then does to the mutex falls on whoever has the memory by now. A GL fence keeps the driver's alive
// as long as nobody has asked whether it has passed. So each mark is two: one to ask, and one that is kept until a
// later mark has passed, which no thread counts before it has let go of the earlier one.
// engine_bridge/README.md says how the fault was found.
class Fences {
 public:
  using Mark = std::uint64_t;

  Fences() = default;
  ~Fences();  // with its context current
  Fences(const Fences&) = delete;
  Fences& operator=(const Fences&) = delete;

  // After all that was asked for so far, which is sent to the device.
  Mark mark();
  // Until the device has come past it, or fails: the next checkGl() reports that. 0 has always passed.
  void wait(Mark mark);
  // Marks whose fences are held.
  std::size_t held() const { return held_.size(); }

 private:
  struct Place {
    GLsync asked, kept;
  };
  void release();  // the oldest

  std::deque<Place> held_;
  Mark oldest_ = 1;  // held_.front()
};

// Of the context that is current. Throws std::logic_error where GlContext did not make it.
Fences& fences();

}  // namespace pellucid::gl
