// One level of the spread pyramid from the one below it, or from the picture.
#include "gl/lookup.glsl"

layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 limits;
layout(location = 2) out vec4 moments;
layout(location = 3) out vec4 reachColour;
layout(location = 4) out vec4 rateColour;

uniform int level;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy) - ivec2(0, spreadLevels[level].z) - PLD_SPREAD_MARGIN;
  SpreadTargets targets = encodeSpread(halvedTexel(level, texel));
  colour = targets.colour;
  limits = targets.limits;
  moments = targets.moments;
  reachColour = targets.reachColour;
  rateColour = targets.rateColour;
}
