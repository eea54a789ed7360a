#include "composite/cli/blur_flags.h"

#include <fmt/format.h>

#include "composite/cli/parse.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {

void BlurFlags::addTo(CLI::App& verb) {
  verb.add_option("--shutter", shutter,
                  "OPEN:CLOSE in frames around the frame, such as -0.25:0.25: each pass of --aa at its own time");
  verb.add_option("--camera-motion", cameraMotion,
                  "Whether the glTF's camera moves while the shutter is open; off holds it where the frame has it")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  verb.add_option("--lens-radius", lensRadius,
                  "Radius of the lens in metres: each pass of --aa from its own point of it");
  verb.add_option("--f-stop", fStop, "The same as a number: the focal length over twice the radius");
  verb.add_option("--focal-length", focalLength,
                  "Of --f-stop: millimetres; without it the header's effectiveFocalLength or nominalFocalLength");
  verb.add_option("--focus", focus,
                  "Distance in focus, along the axis in metres; auto: the header's focus, else the depth in the middle "
                  "of the picture");
  verb.add_option("--lens-blades", blades, "Blades of the aperture, whose corners lie on it; 0 is round")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
}

std::optional<Shutter> BlurFlags::shutterAsked() const {
  if (shutter.empty()) {
    if (cameraMotion == "off")
      throw UsageError("--camera-motion: found off without --shutter, expected one that opens and closes");
    return std::nullopt;
  }
  const auto numbers = parseNumbers(shutter, ':', 2, "--shutter", "OPEN:CLOSE in frames");
  return Shutter{numbers[0], numbers[1], cameraMotion == "off"};
}

LensRequest BlurFlags::lens() const {
  LensRequest lens;
  lens.radius = lensRadius;
  lens.fStop = fStop;
  lens.focalLength = focalLength;
  lens.blades = blades;
  lens.autoFocus = focus == "auto";
  if (!focus.empty() && !lens.autoFocus) lens.focus = parseNumbers(focus, ',', 1, "--focus", "metres, or auto")[0];
  return lens;
}

}  // namespace pellucid::cli
