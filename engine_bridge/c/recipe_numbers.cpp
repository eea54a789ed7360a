#include "engine_bridge/c/recipe_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine_bridge/c/spread_layout.h"

namespace pellucid::c {
namespace {

// How GLSL declares a number, and what it takes in std140.
struct NumberShape {
  const char* type;
  const char* name;
  std::size_t bytes, alignment;
  int count = 1;  // of an array
};

NumberShape shapeOf(StageNumber number) {
  switch (number) {
    case StageNumber::pictureSize:
    case StageNumber::texelSize:
      return {"ivec2", "pictureSize", 8, 8};
    case StageNumber::texelCount:
      return {"ivec2", "texelCount", 8, 8};
    case StageNumber::factor:
      return {"int", "factor", 4, 4};
    case StageNumber::factorAsFloat:
      return {"float", "factor", 4, 4};
    case StageNumber::texelsAPixel:
      return {"float", "texelsAPixel", 4, 4};
    case StageNumber::form:
      return {"int", "form", 4, 4};
    case StageNumber::depthRows:
      return {"vec4", "depthRows", 16, 16};
    case StageNumber::metresPerUnit:
      return {"float", "metresPerUnit", 4, 4};
    case StageNumber::level:
      return {"int", "level", 4, 4};
    case StageNumber::lookup:
      return {"ivec3", "lookup", 12, 16};
    case StageNumber::largestSpread:
      return {"float", "largestSpread", 4, 4};
    case StageNumber::spreadLevels:
      return {"ivec4", "spreadLevels", 16 * SpreadLayout::kLevels, 16, SpreadLayout::kLevels};
    case StageNumber::rowLength:
      return {"int", "rowLength", 4, 4};
    case StageNumber::weight:
      return {"vec4", "weight", 16, 16};
    case StageNumber::depthOpacity:
      return {"float", "depthOpacity", 4, 4};
    default:
      return {"int", "view", 4, 4};
  }
}

template <class T>
void put(std::byte* at, std::initializer_list<T> values) {
  std::memcpy(at, values.begin(), values.size() * sizeof(T));
}

float diagonalOf(const pld_frame& frame) {
  return std::hypot(static_cast<float>(frame.width), static_cast<float>(frame.height));
}

void fillSpread(const FrameNumbers& numbers, StageNumber number, std::byte* at) {
  const SpreadLayout layout = numbers.permutation.has(PLD_FEATURE_DIFFUSION)
                                  ? spreadLayout(numbers.frame.width, numbers.frame.height, numbers.atlasLayers)
                                  : SpreadLayout();
  if (number == StageNumber::spreadLevels)
    std::memcpy(at, layout.levels, sizeof(layout.levels));
  else
    put<int32_t>(at, {0, 0, layout.count});
}

// Of PLD_STAGE_LOW.
void fillLow(const pld_frame& frame, StageNumber number, std::byte* at) {
  switch (number) {
    case StageNumber::factor:
      return put<int32_t>(at, {frame.low_factor});
    case StageNumber::factorAsFloat:
      return put<float>(at, {static_cast<float>(frame.low_factor)});
    case StageNumber::texelsAPixel:
      return put<float>(at, {1.0f / static_cast<float>(frame.low_factor)});
    default:
      return put<int32_t>(at, {frame.width / frame.low_factor, frame.height / frame.low_factor});
  }
}

void fillNumber(const FrameNumbers& numbers, StageNumber number, uint32_t repeat, std::byte* at) {
  const pld_frame& frame = numbers.frame;
  const float* projection = frame.projection;
  switch (number) {
    case StageNumber::pictureSize:
      return put<int32_t>(at, {frame.width, frame.height});
    case StageNumber::form:
      return put<int32_t>(at, {frame.occlusion});
    case StageNumber::depthRows:
      return put<float>(at, {projection[10], projection[14], projection[11], projection[15]});
    case StageNumber::metresPerUnit:
      return put<float>(at, {frame.metres_per_unit});
    case StageNumber::level:
      return put<int32_t>(at, {static_cast<int32_t>(repeat) + 1});
    case StageNumber::lookup:
    case StageNumber::spreadLevels:
      return fillSpread(numbers, number, at);
    case StageNumber::largestSpread:
      return put<float>(at, {diagonalOf(frame)});
    case StageNumber::rowLength:
      return put<int32_t>(at, {numbers.width});
    case StageNumber::weight:
      return put<float>(at, {frame.weight_near, frame.weight_far, frame.weight_exponent, referenceOf(frame)});
    case StageNumber::depthOpacity:
      return put<float>(at, {frame.depth_opacity});
    case StageNumber::view:
      return put<int32_t>(at, {numbers.view});
    default:
      return fillLow(frame, number, at);
  }
}

}  // namespace

void fillSeam(const FrameNumbers& numbers, int pixelsATexel, float* block) {
  const pld_frame& frame = numbers.frame;
  const Focal focal = focalOf(frame, pixelsATexel);
  const float filled[kSeamFloats] = {frame.metres_per_unit,
                                     frame.pre_exposure,
                                     isOrthographic(frame.projection) ? 1.0f : 0.0f,
                                     static_cast<float>(frame.occlusion),
                                     frame.weight_near,
                                     frame.weight_far,
                                     frame.weight_exponent,
                                     static_cast<float>(numbers.width),
                                     static_cast<float>(frame.refract),
                                     frame.refract_distance,
                                     focal.x,
                                     focal.y,
                                     frame.diffusion_k0,
                                     frame.diffusion_k1,
                                     static_cast<float>(frame.width),
                                     static_cast<float>(frame.height),
                                     referenceOf(frame)};
  std::copy(std::begin(filled), std::end(filled), block);
}

std::vector<NumberPlace> placesOf(const std::vector<StageNumber>& stage) {
  std::vector<NumberPlace> places;
  std::size_t end = 0;
  for (const StageNumber number : stage) {
    const NumberShape shape = shapeOf(number);
    end = (end + shape.alignment - 1) / shape.alignment * shape.alignment;
    places.push_back({number, shape.name, shape.type, shape.count, end, shape.bytes});
    end += shape.bytes;
  }
  return places;
}

std::size_t sizeOfStageBlock(const std::vector<StageNumber>& stage) {
  const std::vector<NumberPlace> places = placesOf(stage);
  return places.empty() ? 0 : (places.back().offset + places.back().bytes + 15) / 16 * 16;
}

std::string stageBlockText(const std::vector<StageNumber>& stage, const std::string& layout) {
  if (stage.empty()) return {};
  std::string text = layout + " uniform " + kStageBlock + " {\n";
  for (const StageNumber number : stage) {
    const NumberShape shape = shapeOf(number);
    text += std::string("  ") + shape.type + " " + shape.name;
    if (shape.count > 1) text.append("[").append(std::to_string(shape.count)).append("]");
    text += ";\n";
  }
  return text + "};\n";
}

void fillStage(const FrameNumbers& numbers, const std::vector<NumberPlace>& places, uint32_t repeat, std::byte* block) {
  for (const NumberPlace& place : places) fillNumber(numbers, place.number, repeat, block + place.offset);
}

}  // namespace pellucid::c
