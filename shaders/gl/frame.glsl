#pragma once
// What every stage knows about the frame. Mirrors FrameBlock in engine_bridge/gl/frame_blocks.h.
layout(std140, binding = 0) uniform Frame {
  mat4 clipFromView;
  vec4 surroundings;     // rgb constant environment radiance
  float weightNear;      // metres
  float weightFar;       // metres
  float weightExponent;
  float depthFactor;     // 1 + relative precision of the opaque depth
  ivec4 band;            // list passes: x, y of the band's top left pixel, its width; edge of a probe's cell
  int lightCount;
  int orthographic;
  vec2 viewport;         // pixels
  vec4 refraction;       // PLD_REFRACT_*; metres (fixed); focal length in x and y, pixels
  vec4 diffusion;        // k0, k1 metres; 1 for net coverage; how much occlusion darkens direct light
  mat4 worldFromView;    // turns only
  int atlasEdge;         // of the surroundings' level 0, texels
  float footprint;       // edge of what one sample stands for, pixels
  ivec2 origin;          // of the pass's pixel 0, 0 in the data window
  mat4 volumeOfParticles;  // view space to texels of the light volume, centres at +0.5
  ivec4 texelsOfParticles; // of one light
  float weightReference;   // metres
  float unused;
  vec2 toMiddle;           // from the sample to the pixel's middle, pixels
};

// Row 0 is the top row: the pass sets the clip origin to the upper left.
layout(binding = 5) uniform sampler2D opaqueZ;  // planar metres, +inf where nothing was hit
layout(binding = 6) uniform sampler2D solid;    // nearest fragment that hides everything: rgb, planar z
