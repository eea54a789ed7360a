// Volumes of a deep picture with glass inside of them, against what sorted pieces come to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gbuffer/deep_io.h"
#include "gbuffer/exr_document.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

struct VolumeSample {
  glm::dvec3 light, opacity;  // premultiplied
  double z, zBack;
};
struct PaneInside {
  double z;
  glm::dvec3 colour;
  double alpha;
};

const std::vector<VolumeSample> kSmokeAndWall{
    {{.2, .1, .05}, {.75, .5, .2}, 4, 8}, {{.1, .3, .05}, {.3, .6, .9}, 9, 11}, {{.2, .4, .6}, {1, 1, 1}, 12, 12}};
const std::vector<PaneInside> kPanesInside{{3, {1, .25, .1}, .5},
                                           {4.5, {.3, .9, .1}, .25},
                                           {7, {.1, .2, .9}, .625},
                                           {10, {1, 1, 0}, .5},
                                           {11.5, {0, 1, 1}, .25}};

glm::dvec3 sortedThrough(const std::vector<VolumeSample>& samples, const std::vector<PaneInside>& panes) {
  struct Piece {
    double z;
    glm::dvec3 light, opacity;
  };
  std::vector<Piece> pieces;
  for (const PaneInside& pane : panes) pieces.push_back({pane.z, pane.colour * pane.alpha, glm::dvec3(pane.alpha)});
  for (const VolumeSample& sample : samples) {
    std::vector<double> ends{sample.z};
    for (const PaneInside& pane : panes)
      if (pane.z > sample.z && pane.z < sample.zBack) ends.push_back(pane.z);
    ends.push_back(sample.zBack);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const double part = sample.zBack > sample.z ? (ends[i + 1] - ends[i]) / (sample.zBack - sample.z) : 1.0;
      const glm::dvec3 opacity = 1.0 - glm::pow(1.0 - sample.opacity, glm::dvec3(part));
      pieces.push_back({ends[i] + 1e-6, sample.light * opacity / sample.opacity, opacity});
    }
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.z < b.z; });
  glm::dvec3 seen(0.0), left(1.0);
  for (const Piece& piece : pieces) {
    seen += left * piece.light;
    left *= 1.0 - piece.opacity;
  }
  return seen;
}

class DeepPictureVolumes : public ::testing::Test {
 protected:
  void SetUp() override {
    options.folder = freshFolder("deep-picture-volumes");
    DeepRows rows;
    rows.window = {0, 0, 8, 8};
    rows.offsets.assign(1, 0);
    rows.channels.resize(9);
    for (int i = 0; i < 64; ++i) {
      for (const VolumeSample& s : kSmokeAndWall) {
        const double values[] = {s.light.r,   s.light.g,   s.light.b,   (s.opacity.r + s.opacity.g + s.opacity.b) / 3,
                                 s.opacity.r, s.opacity.g, s.opacity.b, s.z,
                                 s.zBack};
        for (std::size_t c = 0; c < 9; ++c) rows.channels[c].push_back(static_cast<float>(values[c]));
      }
      rows.offsets.push_back(rows.channels[0].size());
    }
    DeepHeader header;
    header.display = header.data = rows.window;
    header.channels = {"R", "G", "B", "A", "AR", "AG", "AB", "Z", "ZBack"};
    DeepWriter writer(options.folder + "/smoke.exr", header);
    writer.write(rows);
    writer.finish();
  }
  static Quad paneAt(double z, const glm::dvec3& colour, double alpha) {
    const auto f = static_cast<float>(z);
    const glm::vec3 c(colour);
    return Quad{{-f, -f, -f}, {2 * f, 0, 0}, {0, 2 * f, 0}, unlit(c.r, c.g, c.b, static_cast<float>(alpha))};
  }
  double worstOf(const std::vector<std::string>& flags, const glm::dvec3& truth) const {
    std::vector<std::string> arguments{"composite", "smoke.exr", "panes.glb", "-o", "out.exr"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    if (ended.code != 0) return INFINITY;
    const ExrDocument out = readExr(options.folder + "/out.exr");
    double worst = 0;
    for (int c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < 64; ++i)
        worst = std::max(worst,
                         std::abs(static_cast<double>(out.parts[0].find(std::string(1, "RGB"[c]))->at(i)) - truth[c]));
    return worst;
  }
  RunOptions options;
};

TEST_F(DeepPictureVolumes, AreCutWhereGlassIsInside) {
  std::vector<Quad> panes;
  for (const PaneInside& pane : kPanesInside) panes.push_back(paneAt(pane.z, pane.colour, pane.alpha));
  writeGlb(options.folder + "/panes.glb", panes);
  const glm::dvec3 truth = sortedThrough(kSmokeAndWall, kPanesInside);
  EXPECT_LE(worstOf({"--aa", "1"}, truth), 1e-6);
  EXPECT_LE(worstOf({}, truth), 1e-6);
  EXPECT_LE(worstOf({"--aa", "1", "--budget", "1M"}, truth), 1e-6);
  EXPECT_LE(worstOf({"--method", "phenomenological", "--tolerance", "0.001"}, truth), 1e-3);
}

TEST_F(DeepPictureVolumes, AreCutWhereOneSheetIs) {
  for (const double z : {3.0, 4.01, 5.0, 6.0, 7.0, 7.99, 8.5, 10.0}) {
    const PaneInside sheet{z, {1, .25, .125}, .5};
    writeGlb(options.folder + "/panes.glb", {paneAt(z, sheet.colour, sheet.alpha)});
    EXPECT_LE(worstOf({"--aa", "1"}, sortedThrough(kSmokeAndWall, {sheet})), 1e-6) << z;
  }
}

}  // namespace
}  // namespace pellucid
