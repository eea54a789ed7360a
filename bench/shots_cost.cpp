#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "bench/shots_cost.h"
#include "tests/support/shots.h"

namespace pellucid::bench {
namespace {

// A type-preserving copy: half stays half.
Command copyOf(const std::string& picture, const std::string& out) {
  return {"oiiotool", picture, "-d", "R=half", "-d", "G=half", "-d", "B=half", "-d", "A=half", "-o", out};
}

struct Shot {
  std::string name, picture, scene;
  std::vector<std::string> flags;
};

Command compositeOf(const Place& place, const Shot& shot, const std::vector<std::string>& more) {
  Command command{place.program, "composite", shot.picture, shot.scene, "-o", place.folder + "/ours.exr"};
  command.insert(command.end(), shot.flags.begin(), shot.flags.end());
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

Shot sampleShot(const Place& place, const std::string& name, int height) {
  costOf({place.generator, place.folder, name, std::to_string(height)});
  const std::string stem = place.folder + "/" + name;
  Shot shot{name, stem + ".exr", stem + ".glb", {}};
  if (name == "bottles") shot.flags = {"--environment", "0.34,0.37,0.42"};
  return shot;
}

Ratio timeRatio(const std::string& name, const Measured& ours, const Measured& theirs, const std::string& against,
                double aim) {
  Ratio ratio{name, against, ours.median.cpuSeconds / theirs.median.cpuSeconds, ours.spread + theirs.spread, aim, ""};
  ratio.figures = fmt::format("{:.2f}, {:.2f} s", ours.median.cpuSeconds, theirs.median.cpuSeconds);
  return ratio;
}

Ratio memoryRatio(const std::string& name, const Measured& ours, const Measured& theirs, double aim) {
  Ratio ratio{name, "the copy", ours.median.megabytes / theirs.median.megabytes, 0.0, aim, ""};
  ratio.figures = fmt::format("{:.0f}, {:.0f} MB", ours.median.megabytes, theirs.median.megabytes);
  return ratio;
}

// A wall in the colours of a picture, written by oiiotool.
std::string wall(const Place& place, int width, int height) {
  const std::string path = fmt::format("{}/wall{}.exr", place.folder, height);
  costOf({"oiiotool",
          "--pattern",
          "noise:type=uniform:min=.2:max=1",
          fmt::format("{}x{}", width, height),
          "3",
          "--chnames",
          "R,G,B",
          "--pattern",
          "constant:color=100",
          fmt::format("{}x{}", width, height),
          "1",
          "--chnames",
          "Z",
          "--chappend",
          "-d",
          "float",
          "-d",
          "R=half",
          "-d",
          "G=half",
          "-d",
          "B=half",
          "-o",
          path});
  return path;
}

// Panes side by side in depth, each over `share` of the picture, before the middle of it.
Shot panes(const Place& place, const std::string& name, int height, int layers, double share, int lights = 0) {
  std::vector<test::Quad> quads;
  for (int i = 0; i < layers; ++i) {
    const float z = -2.0f - static_cast<float>(i * 7 % layers);
    const float half = -0.5f * z * static_cast<float>(std::sqrt(share)), across = half * 16.0f / 9.0f;
    nlohmann::json material = test::unlit(0.8f, 0.5f, 0.2f, 0.25f);
    if (lights > 0) material.erase("extensions");
    quads.push_back({{-across, -half, z}, {2 * across, 0, 0}, {0, 2 * half, 0}, material});
  }
  // One that is never in view, so that a picture without layers is one of the scenes.
  quads.push_back({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, test::unlit(1, 1, 1, 0.5f)});
  test::GlbOptions options;
  for (int i = 0; i < lights; ++i) {
    options.nodes.push_back({{"translation", {i, 1, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    options.extra = {
        {"extensionsUsed", {"KHR_lights_punctual", "KHR_materials_unlit"}},
        {"extensions", {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}, {"intensity", 9.0}}}}}}}}};
  }
  const std::string scene = place.folder + "/" + name + ".glb";
  test::writeGlb(scene, quads, options);
  return {name, wall(place, height * 16 / 9, height), scene, {"--environment", "0,0,0"}};
}

// Costs less those of the first command.
Scaling scalingOf(const std::string& of, const std::vector<double>& sizes, const std::vector<Command>& commands,
                  const std::vector<Command>& without, int runs) {
  std::vector<Command> all = commands;
  all.insert(all.end(), without.begin(), without.end());
  const std::vector<Measured> measured = inTurn(all, runs);
  Scaling scaling;
  scaling.of = of;
  scaling.sizes = sizes;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const Measured& base = measured[commands.size() + (without.size() > 1 ? i : 0)];
    scaling.costs.push_back(std::max(measured[i].median.cpuSeconds - base.median.cpuSeconds, 0.0));
  }
  scaling.exponent = exponentOf(scaling.sizes, scaling.costs);
  return scaling;
}

}  // namespace

std::vector<Ratio> sampleRatios(const Place& place, const std::string& name, double aim) {
  const Shot shot = sampleShot(place, name, 1080);
  const std::vector<Measured> all =
      inTurn({copyOf(shot.picture, place.folder + "/copy.exr"), compositeOf(place, shot, {}),
              compositeOf(place, shot, {"--aa", "1"}), compositeOf(place, shot, {"--method", "phenomenological"})},
             place.runs);
  const std::string what = fmt::format("composite {}, 1080p", name);
  return {timeRatio(what, all[1], all[0], "oiiotool copy", aim),
          timeRatio(what + ", --aa 1", all[2], all[0], "oiiotool copy", 1.6),
          timeRatio(what + ", --method phenomenological", all[3], all[0], "oiiotool copy", 0.0),
          memoryRatio(what + ", peak memory", all[1], all[0], 1.5)};
}

std::vector<Ratio> largeRatios(const Place& place) {
  const Shot small = panes(place, "corner", 2160, 2, 0.01);
  const std::vector<Measured> wide =
      inTurn({copyOf(small.picture, place.folder + "/copy.exr"), compositeOf(place, small, {})}, place.runs);
  return {timeRatio("composite 1% of 3840 x 2160", wide[1], wide[0], "oiiotool copy", 1.5),
          memoryRatio("composite 1% of 3840 x 2160, peak memory", wide[1], wide[0], 0.0)};
}

std::vector<Ratio> edgeRatios(const Place& place) {
  std::vector<Ratio> ratios;
  for (const char* name : {"bottles", "smoke", "street"}) {
    const Shot shot = sampleShot(place, name, 540);
    const std::vector<Measured> all =
        inTurn({compositeOf(place, shot, {"--edges", "off"}), compositeOf(place, shot, {}),
                compositeOf(place, shot, {"--filter", "blackman-harris:1.5"})},
               place.runs);
    const std::string what = fmt::format("composite {}, 540p", name);
    ratios.push_back(timeRatio(what, all[1], all[0], "--edges off", 1.15));
    ratios.push_back(timeRatio(what + ", --filter blackman-harris:1.5", all[2], all[0], "--edges off", 1.15));
  }
  return ratios;
}

std::vector<Ratio> shadowRatios(const Place& place) {
  const Shot shadows = sampleShot(place, "shadows", 360);  // rays for every fragment of every pass: minutes at 1080
  const std::vector<Measured> cast =
      inTurn({compositeOf(place, shadows, {}), compositeOf(place, shadows, {"--shadows", "exact"})}, place.runs);
  return {timeRatio("composite shadows, 360p, --shadows exact", cast[1], cast[0], "without --shadows", 0.0)};
}

std::vector<Ratio> deepRatios(const Place& place, const std::string& deepFile) {
  const std::string a = place.folder + "/a.exr", b = place.folder + "/b.exr", both = place.folder + "/both.exr";
  costOf({deepFile, both, "1920", "1080", "4", "1"});
  costOf({deepFile, a, "1920", "1080", "2", "2"});
  costOf({deepFile, b, "1920", "1080", "2", "3"});
  const std::string ours = place.folder + "/ours.exr", theirs = place.folder + "/theirs.exr";
  const std::vector<Measured> all =
      inTurn({{place.program, "flatten", both, "--type", "half", "-o", ours},
              {"oiiotool", both, "--flatten", "-d", "half", "--compression", "zip", "-o", theirs},
              {place.program, "flatten", a, b, "--type", "half", "-o", ours},
              {"oiiotool", a, b, "--deepmerge", "--flatten", "-d", "half", "--compression", "zip", "-o", theirs}},
             place.runs);
  return {timeRatio("flatten, 4 samples a pixel", all[0], all[1], "oiiotool --flatten, which does not sort", 0.33),
          timeRatio("flatten, 2 files of 2 samples", all[2], all[3], "oiiotool --deepmerge --flatten", 0.33)};
}

std::vector<Scaling> scalingsOf(const Place& place) {
  std::vector<Scaling> scalings;
  const int runs = std::max(1, place.runs / 2 + 1);
  const Shot none = panes(place, "none", 1080, 0, 1.0);
  std::vector<Command> commands;
  for (const double share : {0.0625, 0.25, 1.0})
    commands.push_back(compositeOf(place, panes(place, fmt::format("area{:g}", share), 1080, 2, share), {}));
  scalings.push_back(scalingOf("covered part of 1080p, 2 layers", {0.0625, 0.25, 1.0}, commands,
                               {compositeOf(place, none, {})}, runs));
  commands.clear();
  for (const int layers : {2, 4, 8, 16})
    commands.push_back(
        compositeOf(place, panes(place, fmt::format("layers{}", layers), 1080, layers, 1.0), {"--aa", "2"}));
  scalings.push_back(
      scalingOf("layers, 1080p, --aa 2", {2, 4, 8, 16}, commands, {compositeOf(place, none, {"--aa", "2"})}, runs));
  commands.clear();
  const Shot two = panes(place, "two", 1080, 2, 1.0);
  for (const int passes : {2, 4, 8, 16}) commands.push_back(compositeOf(place, two, {"--aa", std::to_string(passes)}));
  scalings.push_back(
      scalingOf("--aa, 1080p, 2 layers", {2, 4, 8, 16}, commands, {compositeOf(place, none, {"--aa", "2"})}, runs));
  commands.clear();
  std::vector<Command> without;
  std::vector<double> pixels;
  for (const int height : {540, 1080, 2160}) {
    commands.push_back(
        compositeOf(place, panes(place, fmt::format("height{}", height), height, 2, 1.0), {"--aa", "2"}));
    without.push_back(compositeOf(place, panes(place, fmt::format("none{}", height), height, 0, 1.0), {"--aa", "2"}));
    pixels.push_back(height * (height * 16.0 / 9.0));
  }
  scalings.push_back(scalingOf("pixels, 2 layers, --aa 2", pixels, commands, without, runs));
  commands.clear();
  for (const int lights : {1, 2, 4, 8, 16})
    commands.push_back(
        compositeOf(place, panes(place, fmt::format("lights{}", lights), 1080, 2, 1.0, lights), {"--aa", "2"}));
  scalings.push_back(scalingOf("lights, 1080p, 2 lit layers, --aa 2", {1, 2, 4, 8, 16}, commands,
                               {compositeOf(place, none, {"--aa", "2"})}, runs));
  return scalings;
}

}  // namespace pellucid::bench
