#include "shaders/plane_defines.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

using Planes = std::vector<PlaneSpec>;
using Defines = std::vector<std::string>;

constexpr const char* kComponents[] = {".r", ".g", ".b", ".a"};

std::string typeOf(const PlaneSpec& plane) {
  const int components = plane.components();
  return components == 1 ? "float" : "vec" + std::to_string(components);
}

const char* nameOf(PlaneSum sum, const Planes& planes) {
  for (const PlaneSpec& plane : planes)
    if (plane.sum == sum) return plane.name;
  return "";
}

// A macro over the planes that `entry` has text for.
template <class Entry>
std::string listOf(const char* head, const Planes& planes, Entry entry) {
  std::string define = head;
  for (const PlaneSpec& plane : planes)
    if (const std::string text = entry(plane); !text.empty()) define += ' ' + text;
  return define;
}

// What a plane is called in the structs of shaders/shared that pack it; empty for planes that other text writes.
std::string sumField(PlaneSum sum) {
  switch (sum) {
    case PlaneSum::radiance:
      return "radiance";
    case PlaneSum::weight:
      return "weight";
    case PlaneSum::opacity:
      return "opacity";
    case PlaneSum::depth:
      return "depth";
    case PlaneSum::light:
      return "light";
    default:
      return {};
  }
}

std::string frontField(PlaneSum sum) {
  return sum == PlaneSum::frontRadiance ? "radiance" : sum == PlaneSum::frontDepth ? "depth" : "";
}

bool adds(const PlaneSpec& plane) {
  return plane.blend == PlaneBlend::add || plane.blend == PlaneBlend::alphaMinimum;
}

std::string factorText(int power) {
  return power == 0 ? "1.0f" : power == 1 ? "factor" : "factor * factor";
}

std::string texelsName(const PlaneSpec& plane) {
  return std::string(plane.name) + "Texels";
}

std::string valueText(const PlaneSpec& plane) {
  std::string text = typeOf(plane) + "(";
  for (int i = 0; i < plane.components(); ++i) {
    const float x = plane.clear[static_cast<std::size_t>(i)];
    text += std::string(i ? ", " : "") + (std::isinf(x) ? "intBitsToFloat(0x7f800000)" : x == 0.0f ? "0.0f" : "1.0f");
  }
  return text + ")";
}

std::string placeText(const PlacedNumber& place, const Planes& planes) {
  return std::string("P(") + nameOf(place.sum, planes) + ")" + kComponents[place.component];
}

bool has(const Planes& planes, PlaneSum sum) {
  return nameOf(sum, planes)[0] != '\0';
}

// What writers and readers of the layers' planes share.
void defineLayers(const LayerModel& model, const Planes& planes, bool showsThrough, Defines& defines) {
  const auto define = [&](const char* name, bool wanted) {
    if (wanted) defines.emplace_back(name);
  };
  define("SORTED", model.sorted);
  define("GREY", model.grey());
  define("AVERAGED_ONLY", model.averagedOnly());
  define("PUBLISHED", model.published());
  define("FRONT_TAIL", model.front);
  define("SCATTER", model.scatters() && showsThrough);
  define("DISPERSION", model.disperses && showsThrough);
  define("DIFFUSE_IN_ALPHA", model.diffuseInAlpha());
  if (model.published()) return;
  defines.push_back(listOf("SUM_PLANES(F)", planes, [](const PlaneSpec& plane) {
    const std::string field = sumField(plane.sum);
    return field.empty() ? field : "F(" + typeOf(plane) + ", " + plane.name + ", " + field + ")";
  }));
  if (model.front)
    defines.push_back(listOf("FRONT_PLANES(F)", planes, [](const PlaneSpec& plane) {
      const std::string field = frontField(plane.sum);
      return field.empty() ? field : "F(" + typeOf(plane) + ", " + plane.name + ", " + field + ")";
    }));
  if (has(planes, PlaneSum::nearestZ))
    defines.emplace_back(model.scatters() ? "NEAREST_Z nearestZ.r" : "NEAREST_Z nearestZ");
  if (!model.scatters()) return;
  defines.push_back(listOf("SCATTER_PLANES(F)", planes, [](const PlaneSpec& plane) {
    if (!isOfScattering(plane.sum)) return std::string();
    std::string scale;
    for (const int power : plane.pixelPower) scale += (scale.empty() ? "" : ", ") + factorText(power);
    return std::string("F(") + plane.name + ", " + texelsName(plane) + ", " + plane.name + "Around, vec4(" + scale +
           "))";
  }));
  defines.push_back("REFRACTION_Z(P) " + placeText(refractionZPlace(model), planes));
  if (model.nearestDepths || model.diffuses)
    defines.push_back("DIFFUSE_Z(P) " + placeText(diffuseZPlace(model), planes));
}

std::string outputsOf(const char* name, const Planes& planes) {
  return listOf(name, planes, [](const PlaneSpec& plane) {
    return "layout(location = " + std::to_string(plane.target) + ") out " + typeOf(plane) + " " + plane.name + ";";
  });
}

void defineOutputs(const Planes& planes, Defines& defines) {
  defines.push_back(outputsOf("PLANE_OUTPUTS", planes));
  defines.push_back(listOf("ADDED_PLANES(F)", planes, [](const PlaneSpec& plane) {
    return adds(plane) ? "F(" + typeOf(plane) + ", " + plane.name + ")" : std::string();
  }));
  defines.push_back("ADDED_PLANE_COUNT " + std::to_string(std::count_if(planes.begin(), planes.end(), adds)));
}

std::string samplersOf(const char* name, const Planes& planes, int firstUnit) {
  return listOf(name, planes, [&](const PlaneSpec& plane) {
    const int unit = firstUnit < 0 ? plane.unit : firstUnit + plane.target;
    return "layout(binding = " + std::to_string(unit) + ") uniform sampler2D " + plane.name + ";";
  });
}

}  // namespace

std::vector<std::string> weightDefines(const LayerModel& model) {
  return {"WEIGHT " + std::to_string(model.weight), "NORMALISATION " + std::to_string(model.normalisation)};
}

std::vector<std::string> writeDefines(const LayerModel& model, PlaneStage stage) {
  Defines defines = weightDefines(model);
  const Planes planes = planesOf(model, stage);
  if (stage == PlaneStage::layers) defineLayers(model, planes, true, defines);
  defineOutputs(planes, defines);
  if (stage == PlaneStage::layers && model.tier == PlaneTier::half) {
    defines.emplace_back("HALF");
    defines.push_back(listOf("HALF_PLANES(F)", planes, [](const PlaneSpec& plane) {
      if (plane.blend == PlaneBlend::alphaMinimum) return std::string("F(") + plane.name + ".rgb, vec3)";
      return adds(plane) ? std::string("F(") + plane.name + ", " + typeOf(plane) + ")" : std::string();
    }));
  }
  return defines;
}

std::vector<std::string> readDefines(const LayerModel& model, bool showsThrough) {
  const Planes planes = planesOf(model);
  Defines defines;
  defineLayers(model, planes, showsThrough, defines);
  const auto define = [&](const char* name, bool wanted) {
    if (wanted) defines.emplace_back(name);
  };
  for (const PlaneSpec& plane : planes)
    if (plane.sum == PlaneSum::light) defines.push_back("LIGHT_TARGET " + std::to_string(plane.target));
  define("NO_SOLIDS", !model.solids);
  define("HALF_SUMS", model.tier == PlaneTier::half || model.published());
  define("LOW_OVER", model.over());
  Planes all = planes;
  for (const PlaneSpec& plane : planesOf(model, PlaneStage::over)) all.push_back(plane);
  defines.push_back(samplersOf("PLANE_SAMPLERS", all, -1));
  return defines;
}

std::vector<std::string> upsampleDefines(const LayerModel& model, const LayerModel& low) {
  Defines defines = writeDefines(model);
  if (!model.solids) defines.emplace_back("NO_SOLIDS");
  if (!model.scatters()) return defines;
  const Planes texels = planesOf(low);
  defines.push_back(listOf("TEXEL_SAMPLERS", texels, [](const PlaneSpec& plane) {
    const bool read = isOfScattering(plane.sum) || plane.sum == PlaneSum::light || plane.sum == PlaneSum::nearestZ;
    return read ? "layout(binding = " + std::to_string(plane.unit) + ") uniform sampler2D " + texelsName(plane) + ";"
                : std::string();
  }));
  return defines;
}

std::string markOutputs(const LayerModel& model, PlaneStage stage) {
  return outputsOf("MARK_OUTPUTS", planesOf(model, stage));
}

std::vector<std::string> emptyDefines(const LayerModel& model) {
  Planes planes = planesOf(model);
  for (const PlaneSpec& plane : planesOf(model, PlaneStage::marks)) planes.push_back(plane);
  Defines defines;
  defineOutputs(planes, defines);
  defines.push_back(listOf("EMPTY_PLANES(F)", planes, [](const PlaneSpec& plane) {
    return "F(" + typeOf(plane) + ", " + plane.name + ", " + valueText(plane) + ")";
  }));
  return defines;
}

std::string rimSamplers(int firstUnit) {
  return samplersOf("RIM_SAMPLERS", planesOf(LayerModel{}, PlaneStage::rims), firstUnit);
}

bool listsOffsets(const LayerModel& model, PlaneStage stage) {
  return stage == PlaneStage::rims || (stage == PlaneStage::layers && model.scatters());
}

const char* listBlockName(int block) {
  constexpr const char* names[] = {"PldLinks", "PldRadiances", "PldTransmissions", "PldOffsets", "PldDispersions"};
  return names[block];
}

int listBlocks(const LayerModel& model, PlaneStage stage) {
  if (stage == PlaneStage::layers && model.disperses) return 5;
  return listsOffsets(model, stage) ? 4 : 3;
}

}  // namespace pellucid
