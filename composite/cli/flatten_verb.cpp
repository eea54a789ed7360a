#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/budget.h"
#include "composite/cli/over_frames.h"
#include "composite/cli/results.h"
#include "composite/cli/verb_flags.h"
#include "composite/cli/verbs.h"

namespace pellucid::cli {
namespace {

// Over black, as the file says its colours.
void writePreview(const FlattenFlags& flags, const FlatPicture& flat) {
  if (!flags.preview.wanted()) return;
  std::vector<std::string> notes;
  Image<glm::vec4> picture(flat.data.width(), flat.data.height());
  for (std::size_t i = 0; i < picture.size(); ++i) picture[i] = glm::vec4(glm::vec3(flat.light[i]), 1.0f);
  flags.preview.write(flags.colour.request(), flags.colour.assetRoot, statedSpace(flat.like, "", notes), picture);
  say(notes);
}

bool anyNegative(const Image<float>& z) {
  for (std::size_t i = 0; i < z.size(); ++i)
    if (z[i] < 0.0f) return true;
  return false;
}

ExtraLayer layersOf(const FlatPicture& flat) {
  const int width = flat.data.width(), height = flat.data.height();
  const auto plane = [&](auto&& value) {
    Image<float> image(width, height);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.size(), 1 << 16), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) image[i] = value(i);
    });
    return image;
  };
  ExtraLayer layer;
  const char* colours[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    layer.channels.emplace_back(colours[c], plane([&](std::size_t i) { return flat.light[i][c]; }));
    if (flat.colouredOpacity)
      layer.channels.emplace_back(std::string("A") + colours[c],
                                  plane([&](std::size_t i) { return flat.opacity[i][c]; }));
  }
  layer.channels.emplace_back("A", plane([&](std::size_t i) { return flat.opacity[i].w; }));
  layer.channels.emplace_back("Z", plane([&](std::size_t i) { return flat.frontZ[i]; }));
  return layer;
}

void flattenVerb(const FlattenFlags& flags, const FrameRun& frame) {
  const Threads threads(flags.run.threads);
  Stages stages;
  const FlatPicture flat = flattenFiles(
      flags, stages, [&](double share) { frame.voice->stage("flatten", share); }, frame.attributes);
  nlohmann::json report{{"output", flags.output}, {"samples", flat.samples}};
  RunCounts counts;
  counts.fragments = flat.samples;
  reportRun(flags.run, stages, counts, "CPU", report);
}

}  // namespace

FlatPicture flattenFiles(const FlattenFlags& flags, Stages& stages, const std::function<void(double)>& told,
                         const std::map<std::string, std::string>& attributes) {
  flags.preview.check(flags.colour.request(), flags.colour.assetRoot, true);
  // A sample takes its channels as floats: seven at most, and its share of the pointers.
  const std::uint64_t most = parseBudget(flags.budget) / 32;
  FlatPicture flat = stages.time("flatten", [&] { return flattenDeep(flags.files, most, flags.view, told); });
  say(flat.notes);
  if (flat.oddities.notFinite) note("{} deep samples are not numbers and were skipped", flat.oddities.notFinite);
  if (flat.oddities.outOfRange)
    note("{} deep samples have an opacity outside 0 to 1, which was clamped", flat.oddities.outOfRange);
  if (anyNegative(flat.frontZ))
    note("deep samples have negative depth: the most negative of a pixel is taken as the nearest, as OpenEXR has it");
  writePreview(flags, flat);
  if (!flags.output.empty())
    stages.time("write", [&] {
      say(writeLayers(flags.output, flat.display, flat.data, {layersOf(flat)}, attributes, nullptr,
                      flags.type == "half", &flat.like));
    });
  return flat;
}

void FlattenFlags::addTo(CLI::App& verb) {
  verb.add_option("files", files, "Deep EXR files, in any order")->required();
  verb.add_option("-o,--output", output, "Flat EXR to write")->required();
  verb.add_option("--view", view, "View of stereo files, such as left; without it the first deep part");
  verb.add_option("--budget", budget, "Deep samples held at once, in bytes (64M, 2G; at least 1M)")
      ->capture_default_str();
  verb.add_option("--type", type, "Of the flat channels")
      ->check(CLI::IsMember({"float", "half"}))
      ->capture_default_str();
  preview.addTo(verb);
  colour.addConfigTo(verb);
  run.addTo(verb);
}

void addFlatten(CLI::App& app) {
  auto flags = std::make_shared<FlattenFlags>();
  auto sequence = std::make_shared<SequenceFlags>();
  CLI::App* verb = app.add_subcommand("flatten", "Merge deep EXR files and composite their samples, exactly");
  flags->addTo(*verb);
  sequence->addTo(*verb);
  verb->callback([verb, flags, sequence] {
    overFrames(*verb, *sequence, {flags->run.json, [&](const FrameRun& frame) { flattenVerb(*flags, frame); }});
  });
}

}  // namespace pellucid::cli
