// Which GL context is current on a thread, remembered and put back.
#pragma once

namespace pellucid {

class CurrentContext {
 public:
  CurrentContext();  // of the calling thread
  static CurrentContext none() { return CurrentContext(nullptr, nullptr); }
  // Makes it the calling thread's; none where none was. Throws std::logic_error when another thread has it.
  void restore() const;

 private:
  CurrentContext(void* display, void* context) : display_(display), context_(context) {}
  void *display_, *context_;
};

}  // namespace pellucid
