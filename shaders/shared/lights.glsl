#pragma once
// KHR_lights_punctual: what one light sends to one point. Points and lights are in the same space.
struct PunctualLight {
  vec4 position;   // metres; w range in metres, 0 for infinite
  vec4 direction;  // unit, from the light; w 0 directional, 1 point, 2 spot
  vec4 intensity;  // rgb W/m^2 (directional) or W/sr
  vec4 cone;       // spot: x scale, y offset of the cosine; full inside, none outside
};

const float PLD_NEAREST_LIGHT = 1e-6f;  // metres: a point light is no singularity, in scenes of millimetres too

struct Arriving {
  vec3 toLight;     // unit
  vec3 irradiance;  // on a surface that faces the light, W/m^2
};

// The specification's window: 1/d^2, cut smoothly to 0 at the range.
//   metres  to the light
//   range   metres, 0 for infinite
PLD_FN float distanceFalloff(float metres, float range) {
  float d = max(metres, PLD_NEAREST_LIGHT);
  float inverseSquare = 1.0f / (d * d);
  if (range <= 0.0f) return inverseSquare;
  float q = metres / range;
  return inverseSquare * clamp(1.0f - q * q * q * q, 0.0f, 1.0f);
}

PLD_FN Arriving arrivingAt(PunctualLight light, vec3 point) {
  Arriving arriving;
  if (light.direction.w == 0.0f) {
    arriving.toLight = -vec3(light.direction);
    arriving.irradiance = vec3(light.intensity);
    return arriving;
  }
  vec3 path = vec3(light.position) - point;
  float metres = length(path);
  arriving.toLight = metres > 0.0f ? path / metres : -vec3(light.direction);
  float falloff = distanceFalloff(metres, light.position.w);
  if (light.direction.w == 2.0f) {
    float spot = clamp(dot(vec3(light.direction), -arriving.toLight) * light.cone.x + light.cone.y, 0.0f, 1.0f);
    falloff *= spot * spot;
  }
  arriving.irradiance = vec3(light.intensity) * falloff;
  return arriving;
}
