#include "composite/pipeline/weight_file.h"

#include <fmt/format.h>

#include "composite/pipeline/refusals.h"
#include "gbuffer/errors.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/weight_text.h"

namespace pellucid {

Request weighedByFile(const Request& request) {
  const std::string& path = request.sums.weightFrom;
  if (path.empty()) return request;
  const std::optional<std::string> text = exrText(path, kWeightAttribute);
  if (!text)
    throw MeaningError(
        fmt::format("{}: --weight-from: found no attribute {}, expected what composite and accumulate "
                    "write",
                    path, kWeightAttribute));
  const std::optional<shading::WeightSettings> weight = readWeightText(*text);
  if (!weight)
    throw MeaningError(
        fmt::format("{}: --weight-from: attribute {}: found '{}', expected what composite and accumulate "
                    "write",
                    path, kWeightAttribute, *text));
  const std::string made = exrText(path, kMethodAttribute).value_or("");
  if (const Method* method = methodNamed(made); method && !method->weighs)
    throw MeaningError(
        fmt::format("{}: --weight-from: found a picture by {}, whose layers are not weighed, expected one "
                    "by a method that weighs",
                    path, made));
  Request weighed = request;
  setWeight(weighed, *weight);
  return weighed;
}

}  // namespace pellucid
