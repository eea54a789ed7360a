#include "tests/pictures/trial.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <numeric>

#include "composite/antialias.h"
#include "composite/cli/verb_flags.h"
#include "composite/pipeline/compositor.h"
#include "gbuffer/errors.h"

namespace pellucid::test {
namespace {

using reference::Vec4;

constexpr int kPlacesAcross = 12;  // of the reference, along each edge of a pixel
constexpr const char* kJudged[] = {"inner", "filtered", "edge", "mixed"};

std::uint64_t seedOf(const Trial& trial) {
  return trial.seed * 0x5851f42d4c957f2dull + 0x2545f4914f6cdd1dull;  // far apart in one sequence
}

Request requestOf(const std::vector<std::string>& words) {
  CLI::App verb("", "composite");
  cli::CompositeFlags flags;
  flags.addTo(verb);
  try {
    verb.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  return flags.render.request();
}

Image<float> planeOf(const Image<Statement>& statements, const Vec4 Statement::*member, int channel) {
  Image<float> plane(statements.width(), statements.height());
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>((statements[i].*member)[channel]);
  return plane;
}

void keepRight(const std::string& path, const Image<Statement>& statements) {
  const Window window{0, 0, statements.width(), statements.height()};
  std::vector<ExtraLayer> layers{{"", {}}, {"allowed", {}}};
  for (int c = 0; c < 4; ++c) {
    const std::string name(1, "RGBA"[c]);
    layers[0].channels.emplace_back(name, planeOf(statements, &Statement::right, c));
    layers[1].channels.emplace_back(name, planeOf(statements, &Statement::allowed, c));
  }
  writeLayers(path, window, window, layers);
}

// Judges every pixel; the statements that it is farthest from, for the case that is kept.
Image<Statement> judge(const Statements& statements, const Image<glm::vec4>& picture, Outcome& outcome) {
  Image<Statement> kept(picture.width(), picture.height());
  double worst = 1.0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const Vec4 value(picture.at(x, y));
      double here = -1.0;
      for (const Statement& statement : statements.of(x, y)) {
        const double error = statement.error(value);
        Tally tally{1, error > 1.0, error, 0.0};
        for (int c = 0; c < 4; ++c) tally.largest = std::max(tally.largest, std::abs(value[c] - statement.right[c]));
        outcome.tallies[static_cast<std::size_t>(statement.judged)].add(tally);
        if (error > here) kept.at(x, y) = statement;
        here = std::max(here, error);
        if (error <= worst) continue;
        worst = error;
        const Vec4 &right = statement.right, &allowed = statement.allowed;
        outcome.worst = fmt::format(
            "({}, {}) {}: found {:.6f} {:.6f} {:.6f} {:.6f}, right {:.6f} {:.6f} {:.6f} {:.6f} to {:.2g} {:.2g} {:.2g} "
            "{:.2g}",
            x, y, kJudged[static_cast<std::size_t>(statement.judged)], value.r, value.g, value.b, value.a, right.r,
            right.g, right.b, right.a, allowed.r, allowed.g, allowed.b, allowed.a);
      }
    }
  return kept;
}

std::string commandOf(const DrawnFlags& flags) {
  std::string command = "pellucid composite opaque.exr glass.glb -o out.exr";
  for (const std::string& word : flags.words) command += " " + word;
  return command;
}

}  // namespace

void Tally::add(const Tally& other) {
  pixels += other.pixels;
  beyond += other.beyond;
  worst = std::max(worst, other.worst);
  largest = std::max(largest, other.largest);
}

bool Outcome::right() const {
  return refusal.empty() && worst.empty();
}

std::string raysOf(const Trial& trial, int x, int y) {
  Random random(seedOf(trial));
  const DrawnScene scene = drawScene(trial.kind, random);
  const DrawnFlags flags = drawFlags(scene, random);
  const reference::Picture picture(scene.numbers);
  PixelFilter filter = parsePixelFilter(fmt::format("{}:{}", flags.filter.shape, flags.filter.radius));
  std::string told = commandOf(flags) + "\n";
  for (std::size_t m = 0; m < scene.placed.size(); ++m) {
    const reference::Coat& coat = scene.placed[m].coat;
    told += fmt::format("mesh {}: {} triangles, alpha {}, on {}, {} nodes, both sides {}\n", m,
                        scene.placed[m].triangles.size(), coat.colour.a, scene.placed[m].on.solid,
                        scene.placed[m].nodes.size(), coat.bothSides);
  }
  for (int i = 0; i < flags.passes; ++i) {
    const glm::dvec2 place = samplePosition(i, flags.passes, filter);
    const reference::Column column = picture.columnAt(x + place.x, y + place.y);
    told += fmt::format("({:.4f}, {:.4f}): opaque {}.{} at {:.9g};", x + place.x, y + place.y, column.opaque.face.solid,
                        column.opaque.face.side, column.opaque.z);
    for (const reference::Crossing& crossing : column.crossings)
      told += fmt::format(" mesh {} covers {:.4f} at {:.9g}{}", crossing.mesh, crossing.layer.coverage,
                          crossing.layer.z, crossing.on.solid < 0 ? "" : " on it");
    const reference::Shown shown = picture.shownBefore(column);
    told += fmt::format("; light {:.4f} {:.4f} {:.4f}, lets through {:.4f} {:.4f} {:.4f}", shown.light.r, shown.light.g,
                        shown.light.b, shown.transmission.r, shown.transmission.g, shown.transmission.b);
    if (!shown.bends.empty()) {
      const double behind = std::min(column.opaque.z, shown.solidZ);
      const auto offset = reference::landingOf(scene.numbers.eye, scene.numbers.bending, shown.bends, behind).offset;
      told += fmt::format(" from ({:.4f}, {:.4f})", offset[1].x, offset[1].y);
    }
    told += fmt::format("; {:.3g} texels a pixel\n", picture.texelsAPixel(x + place.x, y + place.y));
  }
  return told;
}

Outcome runTrial(const Trial& trial, const std::string& folder, const std::shared_ptr<KeptWork>& kept) {
  Random random(seedOf(trial));
  const DrawnScene scene = drawScene(trial.kind, random);
  const DrawnFlags flags = drawFlags(scene, random);
  std::ofstream(folder + "/number") << fmt::format("{} {}\n", trial.kind, trial.seed);
  return compositeAndJudge(scene, flags, folder, kept);
}

namespace {

// Halves end at 65504, and what is farther is nothing at all.
bool holdsDepths(const reference::Picture& picture, const OpaqueForm& form) {
  const reference::Eye& eye = picture.scene().eye;
  for (int y = 0; y < eye.height; ++y)
    for (int x = 0; x < eye.width; ++x) {
      const reference::Ray ray = reference::rayThrough(eye, x + 0.5, y + 0.5);
      const double z = reference::nearestSolid(picture.scene(), ray).z;
      if (z != reference::kNothing && z * glm::length(ray.along) / form.metresPerUnit > 6e4) return false;
    }
  return true;
}

}  // namespace

Outcome compositeAndJudge(const DrawnScene& scene, const DrawnFlags& drawn, const std::string& folder,
                          const std::shared_ptr<KeptWork>& kept) {
  const reference::Picture picture(scene.numbers);
  DrawnFlags flags = drawn;
  flags.form.half = flags.form.half && holdsDepths(picture, flags.form);
  const reference::Samples samples(picture, flags.filter, kPlacesAcross);
  writeOpaque(folder + "/opaque.exr", picture, samples, flags.form);
  writeScene(folder + "/glass.glb", scene);
  std::vector<std::string> words{folder + "/opaque.exr", folder + "/glass.glb", "-o", folder + "/out.exr"};
  words.insert(words.end(), flags.words.begin(), flags.words.end());
  Outcome outcome;
  outcome.kind = scene.kind;
  std::ofstream(folder + "/command") << commandOf(flags) << "\n";
  try {
    const Request request = requestOf(words);
    Compositor compositor(request, nullptr, nullptr, kept);
    const Result result = compositor.run(request);
    std::vector<glm::dvec2> places;
    for (int i = 0; i < flags.passes; ++i) places.push_back(samplePosition(i, flags.passes, result.plan.pixelFilter));
    const Statements statements(scene, picture, samples, flags, compositor.shot().opaque.gbuffer.beauty, places);
    const Image<Statement> right = judge(statements, result.picture.rgba, outcome);
    if (outcome.right()) return outcome;
    keepRight(folder + "/right.exr", right);
    compositor.write(folder + "/out.exr", result);
  } catch (const Error& error) {
    outcome.refusal = error.what();
  }
  return outcome;
}

std::string tableOf(const std::vector<Outcome>& outcomes) {
  std::string table = "| scene | pictures |";
  std::string line = "| --- | --- |";
  for (const char* name : kJudged) {
    table += fmt::format(" {} | worst | beyond |", name);
    line += " --- | --- | --- |";
  }
  table += "\n" + line + "\n";
  std::vector<std::string> kinds = sceneKinds();
  kinds.emplace_back("all");
  for (const std::string& kind : kinds) {
    std::size_t pictures = 0;
    Tallies sum;
    for (const Outcome& outcome : outcomes) {
      if (kind != "all" && outcome.kind != kind) continue;
      ++pictures;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i].add(outcome.tallies[i]);
    }
    table += fmt::format("| {} | {} |", kind, pictures);
    for (const Tally& tally : sum) table += fmt::format(" {} | {:.3f} | {} |", tally.pixels, tally.worst, tally.beyond);
    table += "\n";
  }
  return table;
}

}  // namespace pellucid::test
