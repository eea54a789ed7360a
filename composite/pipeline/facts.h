// What a plan needs to know of a loaded shot, and nothing of its pixels.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "composite/pipeline/shot.h"
#include "gbuffer/header_time.h"
#include "gbuffer/pixel_filter.h"

namespace pellucid {

struct ShotFacts {
  int width = 0, height = 0;  // of the data window
  bool hasScene = true;       // glTF among the inputs
  bool hasCamera = true;
  bool moves = false;                      // an animation is played
  bool cameraMoves = false;                // and the camera may be among what it moves
  std::optional<OpenShutter> shutter;      // of the picture's header
  std::optional<double> exposure;          // frames, of the same: how long, but not when
  bool deepPicture = false;                // each sample of the opaque picture holds layers out on its own
  std::size_t deepFiles = 0;               // with transparent samples
  bool deepScatters = false;               // they say how they refract and diffuse
  bool marksLowResolution = false;         // some transparent material is to be drawn at low resolution
  std::size_t lights = 0;                  // that shine
  double rangeNear = 0.0, rangeFar = 0.0;  // of the camera, metres; 0 where it has none
  // Depths of all that is transparent, metres: of the whole scene, not of what a frame shows. 0 where nobody has asked
  // or nothing is. The nearer may lie behind the eye.
  double layersNear = 0.0, layersFar = 0.0;
  std::size_t triangles = 0;               // of one copy of every primitive
  std::optional<PixelFilter> pixelFilter;  // of the picture, where its header or its producer says
  std::string pixelFilterBy;               // which of the two, for a sentence
};

// All but the depths of the layers.
ShotFacts factsOf(const Shot& shot);
// Those, which takes a look at every vertex and every deep sample.
void addLayerDepths(const Shot& shot, ShotFacts& facts);

}  // namespace pellucid
