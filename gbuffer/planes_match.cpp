#include "gbuffer/planes_match.h"

#include <fmt/format.h>

#include "gbuffer/camera_match.h"
#include "gbuffer/errors.h"
#include "gbuffer/weight_reference.h"
#include "gbuffer/weight_text.h"

namespace pellucid {
namespace {

std::string windowText(const Window& window) {
  return fmt::format("({}, {}) to ({}, {})", window.x0, window.y0, window.x1 - 1, window.y1 - 1);
}

// Compares what two files say of one thing.
struct Pair {
  const std::string &file, &other;

  void expect(const char* what, const std::string& found, const std::string& expected) const {
    if (found != expected) refuse(what, found, expected);
  }
  void expect(const char* what, const Window& found, const Window& expected) const {
    if (found != expected) refuse(what, windowText(found), windowText(expected));
  }
  void expectView(const Camera& found, const Camera& expected) const {
    if (!sameView(found, expected)) refuse("camera", viewText(found), viewText(expected));
  }
  void expectSpace(const ColourSpace& found, const ColourSpace& expected) const {
    if (!sameSpace(found, expected)) refuse("colour space", found.name, expected.name);
  }
  [[noreturn]] void refuse(const char* what, const std::string& found, const std::string& expected) const {
    throw MeaningError(fmt::format("{}: {}: found {}, expected {} as in {}", file, what, found, expected, other));
  }
};

}  // namespace

void expectSamePlanes(const OitPlanes& planes, const std::string& file, const OitPlanes& before,
                      const std::string& fileBefore) {
  const Pair pair{file, fileBefore};
  pair.expect("display window", planes.display, before.display);
  pair.expect("places", planes.info.places, before.info.places);
  pair.expect("data window", planes.data, before.data);
  pair.expectView(planes.camera, before.camera);
  pair.expectSpace(planes.info.space, before.info.space);
  pair.expect("method", planes.info.method, before.info.method);
  if (!sameButForReference(planes.info.weight, before.info.weight))
    throw MeaningError(fmt::format("{}: weight: found {}, expected {} as in {}: accumulate it with --weight-from {}",
                                   file, weightText(planes.info.weight), weightText(before.info.weight), fileBefore,
                                   fileBefore));
  pair.expect("normalisation", std::to_string(planes.info.normalisation), std::to_string(before.info.normalisation));
  pair.expect("tier", planes.info.tier, before.info.tier);
  if (planes.info.solidHash != before.info.solidHash)
    throw MeaningError(
        fmt::format("{}: found other solids than in {}, expected the same: accumulate each with --held-out-by the "
                    "other, so that what stands behind a solid of one is in neither",
                    file, fileBefore));
}

void refuseReference(const OitPlanes& planes, const std::string& file, const OitPlanes& before,
                     const std::string& fileBefore) {
  throw MeaningError(fmt::format(
      "{}: weight: found a reference depth of {} m, expected {} m as in {}: sums over the one do not fit {} "
      "over the other; accumulate it with --weight-from {}",
      file, planes.info.weight.reference, before.info.weight.reference, fileBefore,
      planes.published() ? "halves" : "floats", fileBefore));
}

void expectSpaceOf(const ColourSpace& picture, const std::string& pictureFile, const OitPlanes& planes,
                   const std::string& file) {
  const SpaceSource source = planes.info.space.source;
  const bool byRule = source == SpaceSource::fileRule || source == SpaceSource::defaultRule;
  if (source == SpaceSource::flag || (byRule && picture.source != SpaceSource::chromaticities)) return;
  Pair{file, pictureFile}.expectSpace(planes.info.space, picture);
}

void expectPlanesOf(const GBuffer& picture, const std::string& pictureFile, const OitPlanes& planes,
                    const Camera& camera, const std::string& file) {
  const Pair pair{file, pictureFile};
  if (planes.info.places.empty()) {
    pair.expect("display window", planes.display, picture.display);
    pair.expect("data window", planes.data, picture.data);
  }
  const bool overruled = camera.origin.find("--camera") != std::string::npos;
  if (picture.camera && !overruled) pair.expectView(camera, *picture.camera);
}

}  // namespace pellucid
