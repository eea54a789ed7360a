#pragma once
// Where a lat-long map shows a direction: as Blender and the common glTF viewers lay it out, so that a map lines up with
// renders. Its middle is +x, a quarter to the right +z, its top row +y.
#include "shared/surface.glsl"

//   direction  world, y up, unit
// u in [0,1] to the right, v in [0,1] downwards
PLD_FN vec2 latLongOf(vec3 direction) {
  float u = 0.5f + atan(direction.z, direction.x) * (0.5f / PLD_PI);
  float v = acos(clamp(direction.y, -1.0f, 1.0f)) * (1.0f / PLD_PI);
  return vec2(u, v);
}

PLD_FN vec3 directionOfLatLong(vec2 uv) {
  float azimuth = (uv.x - 0.5f) * (2.0f * PLD_PI), polar = uv.y * PLD_PI;
  float across = sin(polar);
  return vec3(across * cos(azimuth), cos(polar), across * sin(azimuth));
}

// --- Light of a whole picture, as a shaded fragment looks it up: split sum. One atlas holds it, blurred for each
// roughness, on octahedra: squares of directions without poles, found by + - x / alone.

const int PLD_GLOSSY_LEVELS = 9;   // roughness 0, 1/8 .. 1
const int PLD_DIFFUSE_LEVEL = 9;   // mean radiance by the cosine about the normal
const int PLD_TABLE_LEVEL = 10;    // what GGX reflects: columns cosine to the eye, rows roughness
const int PLD_LEAST_EDGE = 32;     // texels along the smallest squares, and the table

// Texels along the square of a level.
//   edge  of level 0, a power of two, at least PLD_LEAST_EDGE
PLD_FN int levelEdge(int level, int edge) {
  return max(level < PLD_GLOSSY_LEVELS ? edge >> level : 0, PLD_LEAST_EDGE);
}

// First row of a level: they lie below each other.
PLD_FN int levelRow(int level, int edge) {
  int row = 0;
  for (int i = 0; i < level; ++i) row += levelEdge(i, edge);
  return row;
}

// Where the octahedron's square shows a direction. [0,1]^2; +z in its middle
PLD_FN vec2 octahedronOf(vec3 direction) {
  float size = abs(direction.x) + abs(direction.y) + abs(direction.z);
  float x = direction.x / size, y = direction.y / size;
  vec2 folded = vec2(x, y);
  if (direction.z < 0.0f) {
    folded.x = (1.0f - abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
    folded.y = (1.0f - abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
  }
  return folded * 0.5f + vec2(0.5f);
}

// Of any length.
PLD_FN vec3 directionOfOctahedron(vec2 at) {
  float x = at.x * 2.0f - 1.0f, y = at.y * 2.0f - 1.0f;
  float z = 1.0f - abs(x) - abs(y);
  vec3 direction = vec3(x, y, z);
  if (z < 0.0f) {
    direction.x = (1.0f - abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
    direction.y = (1.0f - abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
  }
  return direction;
}

// Four texels of the atlas and how much each counts.
struct AtlasTaps {
  ivec2 a;
  ivec2 b;
  ivec2 c;
  ivec2 d;
  vec4 weights;
};

// A texel beyond the square's border lies on the same border, the other way round.
PLD_FN ivec2 foldedTexel(ivec2 texel, int edge) {
  ivec2 folded = texel;
  if (folded.x < 0 || folded.x >= edge) {
    folded.x = folded.x < 0 ? -1 - folded.x : 2 * edge - 1 - folded.x;
    folded.y = edge - 1 - folded.y;
  }
  if (folded.y < 0 || folded.y >= edge) {
    folded.y = folded.y < 0 ? -1 - folded.y : 2 * edge - 1 - folded.y;
    folded.x = edge - 1 - folded.x;
  }
  return folded;
}

// Bilinear about a direction.
//   direction  world, any length
PLD_FN AtlasTaps directionTaps(vec3 direction, int level, int edge) {
  int own = levelEdge(level, edge), row = levelRow(level, edge);
  vec2 at = octahedronOf(direction) * float(own) - vec2(0.5f);
  vec2 low = floor(at);
  vec2 part = at - low;
  ivec2 first = ivec2(int(low.x), int(low.y)), below = ivec2(0, row);
  AtlasTaps taps;
  taps.a = foldedTexel(first, own) + below;
  taps.b = foldedTexel(first + ivec2(1, 0), own) + below;
  taps.c = foldedTexel(first + ivec2(0, 1), own) + below;
  taps.d = foldedTexel(first + ivec2(1, 1), own) + below;
  taps.weights = vec4((1.0f - part.x) * (1.0f - part.y), part.x * (1.0f - part.y), (1.0f - part.x) * part.y,
                      part.x * part.y);
  return taps;
}

// Bilinear in the table.
PLD_FN AtlasTaps tableTaps(float cosEye, float roughness, int edge) {
  float most = float(PLD_LEAST_EDGE - 1);
  float x = clamp(cosEye, 0.0f, 1.0f) * most, y = clamp(roughness, 0.0f, 1.0f) * most;
  int column = min(int(x), PLD_LEAST_EDGE - 2), line = min(int(y), PLD_LEAST_EDGE - 2);
  float right = x - float(column), down = y - float(line);
  int row = levelRow(PLD_TABLE_LEVEL, edge) + line;
  AtlasTaps taps;
  taps.a = ivec2(column, row);
  taps.b = ivec2(column + 1, row);
  taps.c = ivec2(column, row + 1);
  taps.d = ivec2(column + 1, row + 1);
  taps.weights = vec4((1.0f - right) * (1.0f - down), right * (1.0f - down), (1.0f - right) * down, right * down);
  return taps;
}

// Middle of what a rough surface mirrors: between the mirror's direction and the normal. Lagarde and de Rousiers (Moving
// Frostbite to PBR, 2014). Any length.
PLD_FN vec3 glossyDirection(vec3 normal, vec3 toEye, float roughness) {
  vec3 mirrored = normal * (2.0f * dot(normal, toEye)) - toEye;
  float a = roughness * roughness, smoothness = 1.0f - a;
  float share = smoothness * (sqrt(smoothness) + a);
  return normal + (mirrored - normal) * share;
}

// The two levels about a roughness, and how far it lies towards the second.
struct GlossyLevels {
  int first;
  int second;
  float between;
};

PLD_FN GlossyLevels glossyLevels(float roughness) {
  float level = clamp(roughness, 0.0f, 1.0f) * float(PLD_GLOSSY_LEVELS - 1);
  GlossyLevels levels;
  levels.first = min(int(level), PLD_GLOSSY_LEVELS - 1);
  levels.second = min(levels.first + 1, PLD_GLOSSY_LEVELS - 1);
  levels.between = level - float(levels.first);
  return levels;
}

// Light of the surroundings sent to the eye.
//   diffuse   of PLD_DIFFUSE_LEVEL about the normal
//   glossy    between the two glossy levels about glossyDirection
//   table     x all that GGX reflects of light from everywhere where Fresnel's term is 1; y the cosine at which
//             Fresnel's term is what it is on average
PLD_FN vec3 reflectEnvironment(Surface surface, float cosEye, vec3 diffuse, vec3 glossy, vec4 table) {
  vec3 mirror = specularReflectance(surface, table.y) * table.x;
  precise vec3 reflected = diffuseAlbedo(surface, cosEye) * diffuse + mirror * glossy;
  return reflected;
}
