#pragma once
// How the sums of a pixel lie in the planes that shaders/plane_layout.h gives a pass: encoder beside decoder. A field
// of OitTargets stands for the plane of its name; fields without a plane are neither written nor read.
#include "shared/averaged.glsl"

OitTargets packHere(OitSums sums) {
  OitTargets targets = packSums(sums);
#if defined(AVERAGED_ONLY)
#ifdef GREY
  AveragedTargets averaged = packAveraged(sums, true);
#else
  AveragedTargets averaged = packAveraged(sums, false);
#endif
  targets.radiance = averaged.radiance;
  targets.weight = averaged.weight;
  targets.depth = averaged.depth;
#elif defined(GREY)
  GreyTargets grey = packGrey(sums);
  targets.radiance = grey.radiance;
  targets.opacity = grey.opacity;
#ifdef DIFFUSE_IN_ALPHA
  targets.opacity.z = grey.opacity.a;  // the count, in place of a sum that nothing reads at full resolution
#endif
  targets.depth = vec4(grey.depth, 0.0f, 0.0f);
#endif
  return targets;
}

OitSums unpackHere(OitTargets targets) {
#if defined(AVERAGED_ONLY)
  AveragedTargets averaged;
  averaged.radiance = targets.radiance;
  averaged.weight = targets.weight;
  averaged.depth = targets.depth;
#ifdef GREY
  return unpackAveraged(averaged, true);
#else
  return unpackAveraged(averaged, false);
#endif
#elif defined(GREY)
  GreyTargets grey;
  grey.radiance = targets.radiance;
  grey.opacity = targets.opacity;
#ifdef DIFFUSE_IN_ALPHA
  grey.opacity.a = targets.opacity.z;
  grey.opacity.z = 0.0f;
#endif
  grey.depth = vec2(targets.depth.x, targets.depth.y);
  return unpackSums(unpackGrey(grey, targets.light));
#else
  return unpackSums(targets);
#endif
}

// The places of REFRACTION_Z and DIFFUSE_Z among outputs.
#define PLANE_OUTPUT(plane) plane
