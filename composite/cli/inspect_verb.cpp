#include <fmt/format.h>

#include <nlohmann/json.hpp>

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
  bool devices = false, json = false;
  ReadFlags read;
  SequenceFlags sequence;
};

void inspect(const InspectFlags& flags) {
  if (flags.devices) {
    if (!flags.file.empty()) throw UsageError("inspect: found FILE and --devices, expected one of them");
    const std::vector<std::string> devices = listDevices();
    if (flags.json)
      fmt::print("{}\n", nlohmann::json(devices).dump(2));
    else
      for (const std::string& device : devices) fmt::print("{}\n", device);
    return;
  }
  if (flags.file.empty()) throw UsageError("inspect: found neither FILE nor --devices, expected one of them");
  const nlohmann::json report = inspectExr(flags.file, flags.read.options());
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
  flags->read.addTo(*verb);
  flags->sequence.addTo(*verb, {.sideBySide = true, .resumes = false});
  verb->callback([verb, flags] {
    overFrames(*verb, flags->sequence, {flags->json, [&](const FrameRun&) { inspect(*flags); }});
  });
}

}  // namespace pellucid::cli
