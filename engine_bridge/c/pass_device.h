// The host's GL context as one pass uses it: GL functions, words to the host, saved state, and what every draw of the
// library's own needs. All parts of a pass work over one Device.
#pragma once
#include "engine_bridge/c/kept_fences.h"
#include "engine_bridge/c/pass_permutation.h"
#include "engine_bridge/c/programs.h"
#include "engine_bridge/c/saved_state.h"
#include "engine_bridge/c/timers.h"

namespace pellucid::c {

class Device {
 public:
  GlFunctions gl;
  pld_create_info info{};   // as pld_create() was given it
  Permutation permutation;  // of info; pld_fix() adds constants to it
  Timers timers;
  bool looked = false;         // a whole frame since pld_resize() was drawn, with its textures looked at
  GLenum knownAttachment = 0;  // of the depth of the last frame that was looked at
  char message[512] = {};      // of the last call that failed

  // Takes `create` over and loads GL. Nothing else of this class works before.
  pld_status load(const pld_create_info& create);
  void create();
  void destroy();
  // Whether the context of load() is current on this thread, and not one that shares objects with it.
  bool isCurrent() const;
  // Whether the host was built with the header of this minor version or a later one.
  bool isHostSince(uint32_t minor) const { return isSince(info.version, minor); }

  // Says why, to the message and to the log.
  [[gnu::format(printf, 3, 4)]] pld_status fail(pld_status status, const char* format, ...);
  void say(pld_log_level level, const char* text) const;
  // Of what a judge has written to the message: to the log too, unless the status is PLD_OK.
  pld_status told(pld_status status) const;
  // Of a texture for which factsOf() is false.
  pld_status failTexture(const char* call, const char* field, GLuint name);

  // GL errors that the host has left are reported to the log and cleared.
  void reportPendingErrors(const char* call) const;
  // Clears the errors of a call: GL_OUT_OF_MEMORY where it is among them, else the first, else GL_NO_ERROR.
  GLenum takeErrors() const;

  // Do nothing under PLD_FLAG_HOST_RESTORES.
  void save(Units units, int uniformBinding, Storage storage = {});
  void restore() const;
  void restoreForDraws() const;
  void restoreActiveUnit() const;
  bool saves() const { return !(info.flags & PLD_FLAG_HOST_RESTORES); }

  // Whether the textures of a frame are taken without a look.
  bool trusts() const { return (info.flags & PLD_FLAG_TRUST_TEXTURES) != 0 && looked; }

  void pushGroup(const char* name) const;
  void popGroup() const;

  void bind(GLuint unit, GLuint texture) const;
  void bindSampler(GLuint unit) const;  // nearest texels, none compared
  void use(const Program& program) const;
  // After draws of the host's, before the framebuffer changes; drawEverywhere() does it itself.
  void markDrawn() { fences_.mark(gl); }
  void drawEverywhere();  // over the whole viewport, with the program in use
  // Level 0 alone; adds what it takes to `bytes`. The host's unpack buffer is unbound: see Room.
  GLuint makeTexture(GLenum format, int width, int height, int bits, uint64_t& bytes) const;
  // The same with layers. The array that was bound comes back.
  GLuint makeArray(GLenum format, int width, int height, int layers, int bits, uint64_t& bytes) const;
  void releaseTexture(GLuint& name) const;
  void makeFrame(GLuint& frame) const;
  void releaseFrame(GLuint& frame) const;
  void attach(GLuint frame, GLenum attachment, GLuint texture) const;
  void attachLayer(GLuint frame, GLenum attachment, GLuint array, int layer) const;
  bool isComplete() const;                              // the bound draw framebuffer
  void allowColours(GLuint first, bool written) const;  // draw buffers from `first` on

 private:
  SavedState saved_;
  KeptFences fences_;
  GLuint vertexArray_ = 0, sampler_ = 0;
  char label_[64] = {};  // of vertexArray_
};

// The state in which textures and buffers are made; what the host had comes back at its end.
class Room {
 public:
  Room(Device& device, Storage storage);
  ~Room();
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

 private:
  Device& device_;
  SavedState state_;
  GLint unpack_ = 0;
};

}  // namespace pellucid::c
