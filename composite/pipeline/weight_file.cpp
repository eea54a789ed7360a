#include "composite/pipeline/weight_file.h"

#include <fmt/format.h>

#include "composite/pipeline/default_weight.h"
#include "composite/pipeline/refusals.h"
#include "gbuffer/errors.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/weight_text.h"

namespace pellucid {

namespace {

// Whether the weight would be fitted, but for planes that hold these out.
bool takesOthers(const Request& request) {
  if (request.heldOutBy.empty() || request.sums.fitWeight) return false;
  Request alone = request;
  alone.heldOutBy.clear();
  return fitsWeight(alone);
}

}  // namespace

Request weighedByFile(const Request& request) {
  const bool asked = !request.sums.weightFrom.empty();
  if (!asked && !takesOthers(request)) return request;
  const std::string& path = asked ? request.sums.weightFrom : request.heldOutBy[0];
  const char* flag = asked ? "--weight-from" : "--held-out-by";
  const std::optional<std::string> text = exrText(path, kWeightAttribute);
  if (!text)
    throw MeaningError(fmt::format("{}: {}: found no attribute {}, expected what composite and accumulate write", path,
                                   flag, kWeightAttribute));
  const std::optional<shading::WeightSettings> weight = readWeightText(*text);
  if (!weight)
    throw MeaningError(fmt::format("{}: {}: attribute {}: found '{}', expected what composite and accumulate write",
                                   path, flag, kWeightAttribute, *text));
  const std::string made = exrText(path, kMethodAttribute).value_or("");
  if (const Method* method = methodNamed(made); method && !method->weighs)
    throw MeaningError(
        fmt::format("{}: {}: found a picture by {}, whose layers are not weighed, expected one by a method that weighs",
                    path, flag, made));
  Request weighed = request;
  setWeight(weighed, *weight);
  return weighed;
}

}  // namespace pellucid
