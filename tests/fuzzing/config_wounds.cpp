#include "tests/fuzzing/config_wounds.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "composite/colour/display.h"
#include "gbuffer/errors.h"
#include "tests/fuzzing/header_wounds.h"

namespace pellucid::test {
namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr const char* kConfig = R"(ocio_profile_version: 2
search_path: .
roles: {aces_interchange: reference, default: reference, scene_linear: working, log: camera}
file_rules:
  - !<Rule> {name: plates, extension: exr, pattern: "*plate*", colorspace: working}
  - !<Rule> {name: Default, colorspace: default}
displays:
  screen:
    - !<View> {name: plain, colorspace: shown}
    - !<View> {name: film, colorspace: shown, looks: dim}
looks:
  - !<Look> {name: dim, process_space: reference, transform: !<CDLTransform> {slope: [0.5, 0.5, 0.5]}}
colorspaces:
  - !<ColorSpace> {name: reference, aliases: [ap0]}
  - !<ColorSpace> {name: working, to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}}
  - !<ColorSpace>
    name: camera
    to_scene_reference: !<BuiltinTransform> {style: ARRI_ALEXA-LOGC-EI800-AWG_to_ACES2065-1}
  - !<ColorSpace>
    name: turned
    to_scene_reference: !<MatrixTransform> {matrix: [0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1]}
  - !<ColorSpace> {name: shown, from_scene_reference: !<FileTransform> {src: curve.spi1d, interpolation: linear}}
)";

// Against OpenColorIO, which is asked for the same two spaces directly.
std::string wrongSpace(const std::string& file, const std::string& name, const ColourSpace& found) {
  const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(file.c_str());
  if (!config->hasRole("aces_interchange")) return "";
  const ocio::ConstCPUProcessorRcPtr steps =
      config->getProcessor("aces_interchange", name.c_str())->getDefaultCPUProcessor();
  const glm::dmat3 fromAces =
      found.fromRec709 * glm::inverse(spaceOf(namedSpace("ACES2065-1")->chromaticities)->fromRec709);
  for (const glm::vec3& colour : {glm::vec3(1, 1, 1), glm::vec3(0.8f, 0.1f, 0.3f), glm::vec3(0.02f, 0.5f, 4.0f)}) {
    glm::vec3 theirs = colour;
    steps->applyRGB(&theirs.x);
    const glm::dvec3 ours = fromAces * glm::dvec3(colour);
    for (int c = 0; c < 3; ++c)
      if (!(std::abs(ours[c] - static_cast<double>(theirs[c])) <= 2e-3 * (1 + std::abs(ours[c]))))
        return fmt::format("space {}: found {}, {} by OpenColorIO", name, ours[c], theirs[c]);
  }
  return "";
}

}  // namespace

void writeConfigTables(const std::string& folder) {
  std::ofstream curve(folder + "/curve.spi1d");
  curve << "Version 1\nFrom 0 4\nLength 64\nComponents 1\n{\n";
  for (int i = 0; i < 64; ++i) curve << std::pow(i / 63.0, 0.45) << "\n";
  curve << "}\n";
}

std::string configTrial(std::uint64_t number, const std::string& file, bool& refused) {
  Random random(number);
  spit(file, woundedText(kConfig, random));
  std::string wrong;
  try {
    const ColourConfig config = ColourConfig::read(file, "--ocio");
    for (const char* name : {"working", "reference", "scene_linear", "camera", "turned"}) {
      try {
        const ColourSpace found = config.space(name);
        if (wrong.empty()) wrong = wrongSpace(file, name, found);
      } catch (const Error&) {
        refused = true;
      }
    }
    config.spaceOfFile("plate.exr");
    Image<glm::vec3> shown(4, 1, glm::vec3(0.4f));
    DisplayTransform(config, {}, *spaceOf(namedSpaces()[0].chromaticities)).apply(shown);
  } catch (const Error&) {
    refused = true;
  } catch (const std::exception& error) {
    return fmt::format("throws '{}'", error.what());
  }
  return wrong;
}

}  // namespace pellucid::test
