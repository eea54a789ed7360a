#include "composite/pipeline/lens.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <initializer_list>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

struct Stated {
  double value = 0.0;
  const char* by = nullptr;
};

// A float of the header above 0, by the first of these names that has one.
std::optional<Stated> stated(const ExrDocument& document, std::initializer_list<const char*> names) {
  for (const char* name : names)
    for (const ExrPart& part : document.parts) {
      const auto found = part.attributes.find(name);
      if (found == part.attributes.end() || found->second.type != "float" || found->second.bytes.size() != 4) continue;
      float value = 0.0f;
      std::memcpy(&value, found->second.bytes.data(), sizeof value);
      if (std::isfinite(value) && value > 0.0f) return Stated{static_cast<double>(value), name};
    }
  return std::nullopt;
}

double radiusOf(const LensRequest& request, const ExrDocument& document, Journal& journal) {
  if (request.radius) return *request.radius;
  double millimetres = request.focalLength.value_or(0.0);
  if (!request.focalLength) {
    const auto found = stated(document, {"effectiveFocalLength", "nominalFocalLength"});
    if (!found)
      throw MeaningError(fmt::format(
          "{}: found no effectiveFocalLength or nominalFocalLength for --f-stop, expected one, or --focal-length MM",
          document.path));
    millimetres = found->value;
    journal.note(fmt::format("lens: {:g} mm by attribute {} (--focal-length MM sets it)", millimetres, found->by));
  }
  return millimetres / 1000.0 / (2.0 * *request.fStop);
}

double focusOf(const LensRequest& request, const ExrDocument& document, const GBuffer& gbuffer, Journal& journal) {
  if (request.focus) return *request.focus;
  if (const auto found = stated(document, {"focus"})) {
    journal.note(fmt::format("focus: {:g} m by attribute focus (--focus METRES sets it)", found->value));
    return found->value;
  }
  const int x = gbuffer.data.width() / 2, y = gbuffer.data.height() / 2;
  const auto z = static_cast<double>(gbuffer.viewZ.at(x, y));
  if (!std::isfinite(z))
    throw MeaningError(fmt::format(
        "{}: --focus auto: found nothing opaque in the middle of the picture, expected --focus METRES", document.path));
  journal.note(fmt::format("focus: {:.6g} m, the depth in the middle of the picture (--focus METRES sets it)", z));
  return z;
}

void expectAbove(const std::optional<double>& value, double least, bool exclusive, const char* flag) {
  if (value && !(std::isfinite(*value) && (exclusive ? *value > least : *value >= least)))
    throw UsageError(fmt::format("{}: found {:g}, expected a finite number {} {:g}", flag, *value,
                                 exclusive ? "above" : "from", least));
}

}  // namespace

void checkLens(const LensRequest& request) {
  expectAbove(request.radius, 0.0, false, "--lens-radius");
  expectAbove(request.fStop, 0.0, true, "--f-stop");
  expectAbove(request.focalLength, 0.0, true, "--focal-length");
  expectAbove(request.focus, 0.0, true, "--focus");
  if (request.radius && request.fStop)
    throw UsageError("--f-stop: found it with --lens-radius, expected one of them: both say how wide the lens is");
  if (request.focalLength && !request.fStop)
    throw UsageError("--focal-length: found it without --f-stop, expected it with that: a radius is in metres");
  if (!request.on() && (request.focus || request.autoFocus))
    throw UsageError("--focus: found it without a lens, expected --lens-radius METRES or --f-stop N");
  if (!request.on() && request.blades != 0)
    throw UsageError("--lens-blades: found it without a lens, expected --lens-radius METRES or --f-stop N");
  if (request.on() && !request.focus && !request.autoFocus)
    throw UsageError(fmt::format("{}: found it without --focus, expected --focus METRES or --focus auto",
                                 request.radius ? "--lens-radius" : "--f-stop"));
  if (request.blades == 1 || request.blades == 2)
    throw UsageError(
        fmt::format("--lens-blades: found {}, expected 0 for a round lens, or 3 and more", request.blades));
}

Lens lensOf(const LensRequest& request, const ExrDocument& document, const GBuffer& gbuffer, const Camera& camera,
            Journal& journal) {
  Lens lens;
  if (!request.on()) return lens;
  if (camera.orthographic)
    throw MeaningError(
        fmt::format("{}: found an orthographic camera with --lens-radius or --f-stop, expected a "
                    "perspective one: every point of an orthographic picture is taken from elsewhere",
                    document.path));
  lens.radius = radiusOf(request, document, journal);
  if (lens.radius > 0.0) lens.focus = focusOf(request, document, gbuffer, journal);
  lens.blades = request.blades;
  return lens;
}

Camera throughLens(const Camera& camera, const Lens& lens, glm::dvec2 point) {
  if (!lens.open()) return camera;
  const glm::dvec2 at = lens.radius * point;
  Camera moved = camera;
  glm::dmat4 shift(1.0);
  shift[3] = glm::dvec4(-at, 0.0, 1.0);
  moved.viewFromWorld = shift * camera.viewFromWorld;
  moved.centre = camera.centre + camera.focal * at / lens.focus;
  return moved;
}

}  // namespace pellucid
