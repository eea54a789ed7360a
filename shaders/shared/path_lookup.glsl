#pragma once
// Looking the backdrop up along a pixel's path: refracted to another place, spread by diffusion. Whoever includes this
// includes gather.glsl, or gives the same bits in another way.

// What a path from this pixel's centre shows of the backdrop.
//   own  what the pixel shows straight behind its layers
PLD_FN vec4 lookupAlong(LookupChoice settings, Path path, ivec2 pixel, vec4 own) {
  precise vec2 centre = vec2(float(pixel.x) + 0.5f, float(pixel.y) + 0.5f);
  vec2 place = centre;
  Gathered tap = nothingGathered();
  if (path.refracts) {
    precise vec2 bent = centre + path.offset;
    place = bent;
    tap = gatherBilinear(place, path.refractionZ, pixel, own);
  }
  vec4 undiffused = vec4(0.0f);
  if (tap.weight > 0.0f) {
    precise vec4 mean = tap.colour / tap.weight;
    undiffused = mean;
  } else {
    place = centre;
    undiffused = own;
  }
  if (path.variance <= 0.0f) return undiffused;
  Gathered spread = gatherSpread(settings, place, path.variance, path.diffuseZ);
  if (spread.weight <= 0.0f) return undiffused;
  precise vec4 diffused = spread.colour / spread.weight;
  float share = kernelShare(path.variance);
  if (share >= 1.0f || !isFiniteColour(undiffused)) return diffused;
  precise vec4 both = undiffused + share * (diffused - undiffused);
  return both;
}

// Each channel along its own path.
//   dispersion  offset of red minus the path's, of blue minus it
PLD_FN vec4 lookupAt(LookupChoice settings, Path path, vec4 dispersion, ivec2 pixel, vec4 own) {
  vec4 seen = lookupAlong(settings, path, pixel, own);
  if (!path.refracts || (dispersion.x == 0.0f && dispersion.y == 0.0f && dispersion.z == 0.0f && dispersion.w == 0.0f))
    return seen;
  Path red = path, blue = path;
  precise vec2 redOffset = path.offset + vec2(dispersion.x, dispersion.y);
  precise vec2 blueOffset = path.offset + vec2(dispersion.z, dispersion.w);
  red.offset = redOffset;
  blue.offset = blueOffset;
  seen.r = lookupAlong(settings, red, pixel, own).r;
  seen.b = lookupAlong(settings, blue, pixel, own).b;
  return seen;
}
