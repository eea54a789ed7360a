// One fragment of a transparent caster, as its light sees it: the nearest depth by the coins, and what it hides.
#include "gl/frame.glsl"
#include "gl/material.glsl"
#include "gl/exact_cut.glsl"
#include "gl/identity.glsl"
#include "gl/shadow_frame.glsl"
#include "gl/caster_output.glsl"
#ifdef POINTS
#include "shared/particle.glsl"
#endif

void main() {
  Surface surface = surfaceHere();
  if (outsideTriangle()) discard;
#ifdef POINTS
  float square = dot(textureUv.xy, textureUv.xy);
  if (square >= 1.0f) discard;
  surface.coverage = ballCoverage(surface.coverage, sqrt(1.0f - square));
#endif
  if (!(-viewPosition.z > 0.0f) || !(surface.coverage > 0.0f)) discard;
  float depth = mapDepthOf(viewPosition);
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (depth > texelFetch(opaqueZ, texel, 0).r + metric.w) {
    writeCulled();
    return;
  }

  vec3 toLight = orthographic != 0 ? vec3(0.0f, 0.0f, 1.0f) : normalize(-viewPosition);
  vec3 normal = normalTowardsEye(viewNormal, gl_FrontFacing, toLight);
  float cosLight = clamp(abs(dot(normal, toLight)), PLD_GRAZING, 1.0f);
  vec3 rho = casterDensity(surface, cosLight, material.scattering.z);

  uvec2 place = uvec2(texel) + texels.xy;
  uint key = casterKeyOf(identityOf(instanceIdentity, triangleNumber), texels.w);
  writeCaster(rho, depth, place, key, texels.z != 0u);
}
