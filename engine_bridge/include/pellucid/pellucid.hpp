/* The C library as C++11 classes: what is created is destroyed, what is begun is ended, and what fails is thrown.
   Header only; it calls nothing but pellucid.h, whose comments hold. */
#ifndef PELLUCID_HPP
#define PELLUCID_HPP

#include <pellucid/pellucid.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace pld {

// A call that did not return PLD_OK, with the library's sentence.
class Error : public std::runtime_error {
 public:
  Error(pld_status status, const std::string& sentence) : std::runtime_error(sentence), status_(status) {}
  pld_status status() const { return status_; }

 private:
  pld_status status_;
};

// One view. Made, used and destroyed with one GL context current; moved, never copied.
class Pass {
 public:
  Pass() = default;
  // What `info` leaves out (see pld_create_info_init()) is as in C. Throws Error.
  explicit Pass(pld_create_info info) {
    char message[512] = {};
    if (!info.message) {
      info.message = message;
      info.message_size = sizeof(message);
    }
    const pld_status status = pld_create(&info, &pass_);
    if (status != PLD_OK)
      throw Error(status, info.message[0] ? std::string(info.message) : std::string(pld_status_name(status)));
  }
  ~Pass() { pld_destroy(&pass_); }
  Pass(Pass&& other) noexcept : pass_(other.pass_) { other.pass_ = nullptr; }
  Pass& operator=(Pass&& other) noexcept {
    std::swap(pass_, other.pass_);
    return *this;
  }
  Pass(const Pass&) = delete;
  Pass& operator=(const Pass&) = delete;

  explicit operator bool() const { return pass_ != nullptr; }
  pld_pass* get() const { return pass_; }  // for calls that this class has no name for

  // Each throws Error.
  void fix(const pld_frame& frame, uint32_t fields) { check(pld_fix(pass_, &frame, fields)); }
  void resize(int32_t width, int32_t height) { check(pld_resize(pass_, width, height)); }
  const char* glsl(pld_stage stage, int32_t version) {
    const char* text = nullptr;
    check(pld_glsl(pass_, stage, version, &text));
    return text;
  }
  const char* shadowGlsl(pld_shadow_text which, int32_t version) {
    const char* text = nullptr;
    check(pld_shadow_glsl(pass_, which, version, &text));
    return text;
  }
  void connect(uint32_t program) { check(pld_connect(pass_, program)); }

  // begin, draws(), end. Where draws() throws, the stage is ended before the exception goes on.
  template <class Draws>
  void stage(pld_stage which, const pld_frame& frame, Draws&& draws) {
    check(pld_begin(pass_, which, &frame));
    try {
      std::forward<Draws>(draws)();
    } catch (...) {
      pld_end(pass_);
      throw;
    }
    check(pld_end(pass_));
  }
  void resolve(const pld_target& target) { check(pld_resolve(pass_, &target)); }
  // What later passes ask of the layers, into a texture: PLD_VIEW_MOTION and its like.
  void resolve(pld_view view, uint32_t texture) {
    pld_target target = pld_target_init(PLD_TARGET_TEXTURE, texture);
    target.view = view;
    resolve(target);
  }

  void shadowResize(const pld_shadow_info& info) { check(pld_shadow_resize(pass_, &info)); }
  void releaseShadows() { check(pld_shadow_resize(pass_, nullptr)); }
  template <class Draws>
  void shadowFace(const pld_shadow_view& view, Draws&& draws) {
    check(pld_shadow_begin(pass_, &view));
    try {
      std::forward<Draws>(draws)();
    } catch (...) {
      pld_shadow_end(pass_);
      throw;
    }
    check(pld_shadow_end(pass_));
  }

  uint64_t query(pld_value what) const {
    uint64_t value = 0;
    check(pld_query(pass_, what, &value));
    return value;
  }

 private:
  void check(pld_status status) const {
    if (status == PLD_OK) return;
    const char* const sentence = pass_ ? pld_message(pass_) : "";
    throw Error(status, sentence && sentence[0] ? std::string(sentence) : std::string(pld_status_name(status)));
  }

  pld_pass* pass_ = nullptr;
};

}  // namespace pld
#endif
