// What the frames of a shot do not have to do again: the GL device with its programs; the glTF with its textures, here
// and on the device; a picture that serves several frames, with what is known of its depth and its edges.
#pragma once
#include <memory>

#include "composite/pipeline/device.h"
#include "composite/pipeline/picture_depth.h"
#include "composite/pipeline/shot.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid {

// Of one thread, as Compositor is. It may be handed from one Compositor to the next, and outlives the last of them.
struct KeptWork {
  //   number  of the EGL device; -1 takes the first
  explicit KeptWork(int number) : device(number) {}
  ~KeptWork() { forget(); }
  KeptWork(const KeptWork&) = delete;
  KeptWork& operator=(const KeptWork&) = delete;

  // All but the device.
  void forget() {
    const Device::Turn turn(device);
    triangles.reset();
    depth = PictureDepth();
    shot.reset();
  }

  Device device;
  // Of the frame before, where it was finished; the others are of this shot.
  std::unique_ptr<Shot> shot;
  std::unique_ptr<TransparentPass> triangles;
  PictureDepth depth;
};

}  // namespace pellucid
