// What the frames of a shot do not have to do again: the GL device with its programs.
#pragma once
#include "composite/pipeline/device.h"

namespace pellucid {

// Of one thread, as Compositor is. It may be handed from one Compositor to the next, and outlives the last of them.
struct KeptWork {
  //   number  of the EGL device; -1 takes the first
  explicit KeptWork(int number) : device(number) {}
  Device device;
};

}  // namespace pellucid
