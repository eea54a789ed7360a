#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "composite/cli/file_page.h"
#include "composite/cli/options.h"
#include "composite/cli/over_frames.h"
#include "composite/cli/verbs.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "gbuffer/errors.h"
#include "gbuffer/inspect.h"

namespace pellucid::cli {
namespace {

struct InspectFlags {
  std::string file;
  std::string page, camera;
  std::vector<std::string> scenes;
  bool devices = false, json = false;
  ReadFlags read;
  PageDisplayFlags shown;
  SequenceFlags sequence;
};

void printDevices(bool json) {
  const std::vector<std::string> devices = listDevices();
  if (json)
    fmt::print("{}\n", nlohmann::json(devices).dump(2));
  else
    for (const std::string& device : devices) fmt::print("{}\n", device);
}

// What the page alone reads.
void checkPage(const InspectFlags& flags) {
  if (!flags.scenes.empty() && flags.page.empty())
    throw UsageError("--scene: found it without --html, expected --html FILE.html: the page shows the scene");
  if (!flags.camera.empty() && flags.scenes.empty())
    throw UsageError("--camera: found it without --scene, expected --scene FILE.glb: the camera sees that");
  flags.shown.check(!flags.page.empty());
}

void inspect(const InspectFlags& flags) {
  if (flags.devices) {
    if (!flags.file.empty()) throw UsageError("inspect: found FILE and --devices, expected one of them");
    if (!flags.page.empty()) throw UsageError("inspect: found --html and --devices, expected one of them");
  }
  checkPage(flags);
  if (flags.devices) return printDevices(flags.json);
  if (flags.file.empty()) throw UsageError("inspect: found neither FILE nor --devices, expected one of them");
  const CameraChoice camera = cameraChoice(flags.camera);
  const nlohmann::json report = inspectExr(flags.file, flags.read.options());
  if (!flags.page.empty())
    writeFilePage(flags.page, flags.file, report, flags.read.options(), flags.scenes, camera, flags.shown);
  if (flags.json)
    fmt::print("{}\n", report.dump(2));
  else
    fmt::print("{}", inspectionText(report));
}

}  // namespace

void addInspect(CLI::App& app) {
  auto flags = std::make_shared<InspectFlags>();
  CLI::App* verb = app.add_subcommand("inspect", "What an EXR holds and how it is understood");
  verb->add_option("file", flags->file, "EXR");
  verb->add_flag("--devices", flags->devices, "List the GL devices");
  verb->add_flag("--json", flags->json, "Print results as JSON");
  verb->add_option("--html", flags->page,
                   "Self-contained page to write: layers, channels, histogram of depth, the camera from above");
  verb->add_option("--scene", flags->scenes,
                   "Of --html: glTF, GLB or deep EXR that the page shows over the picture and from above")
      ->allow_extra_args(false);
  verb->add_option("--camera", flags->camera,
                   "Of --scene: glTF camera by name, eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES, or fit[:A,E]");
  flags->shown.addTo(*verb, "--html");
  flags->read.addTo(*verb);
  flags->sequence.addTo(*verb, {.sideBySide = true, .resumes = false});
  verb->callback([verb, flags] {
    overFrames(*verb, flags->sequence, {flags->json, [&](const FrameRun&) { inspect(*flags); }});
  });
}

}  // namespace pellucid::cli
