// The rendered foliage layer of `pellucid occlusion`, and how it and the picture are read.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "composite/occlusion.h"
#include "gbuffer/opaque_io.h"

namespace pellucid::cli {

// Of a layer whose rims are occluded already.
inline constexpr const char* kOcclusionAttribute = "pellucid:occlusion";

// A file whose depth is converted, where its kind asks for it, by the camera of --camera or else by its own.
OpaqueFile readThroughCamera(const std::string& path, const ReadOptions& options, const std::string& camera);

// The same of the layer, whose flags are --layer-beauty and --layer-depth. Throws MeaningError for a layer without
// coverage, or one that is occluded already.
OpaqueFile readFoliageLayer(const std::string& path, const ReadOptions& options, const std::string& camera);

// The light of the layer that came from all around, premultiplied as its beauty is.
//   wanted  a layer's name, "beauty" for all light, "" for what is named indirect or ambient
// Throws MeaningError when there is none, or more than one.
Image<glm::vec3> indirectLight(const OpaqueFile& layer, const std::string& wanted);

FoliagePlanes foliageOf(const GBuffer& layer);

// What --json prints of it: rims, those without depth or without anything opaque beside them, and the mean occlusion.
nlohmann::json occlusionReport(const InferredOcclusion& inferred, const FoliagePlanes& foliage);

}  // namespace pellucid::cli
