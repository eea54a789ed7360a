#include "composite/pipeline/validate.h"

#include <fmt/format.h>

#include "composite/pipeline/colour_step.h"
#include "composite/pipeline/fog_text.h"
#include "composite/pipeline/foliage_step.h"
#include "composite/pipeline/memory_picture.h"
#include "composite/pipeline/refusals.h"
#include "composite/pipeline/shadow_step.h"
#include "engine_bridge/scene/set_keys.h"
#include "gbuffer/errors.h"

namespace pellucid {

void validate(const Request& request) {
  for (const Refusal& row : refusals())
    if (request.methodFrom.empty() && row.applies(request))  // else the method is not known yet
      throw UsageError(fmt::format("{}: found {} with {}, expected {}: {}", row.flag, row.found,
                                   fmt::format(fmt::runtime(row.with), request.method), row.expected, row.why));
  checkMemoryPicture(request.shot);
  gltf::checkOverrides(request.shot.scene.overrides);
  checkTime(request.shot.time);
  if (request.shutter) checkShutter(*request.shutter);
  checkLens(request.lens);
  checkColours(request.shot.colour);
  checkShadows(request.shadows);
  checkFoliage(request.foliage);
  if (request.fog.on() && request.fog.file.empty()) checkFog(request.fog.text.value_or(FogText()), request.fog.grids);
}

}  // namespace pellucid
