// Khronos' own test scenes: each one's glass over its own opaque part, and what their labels say must be seen. Skipped
// without ../shared/assets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>

#include "gbuffer/exr_document.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

// A camera at (x, y, distance) that looks along -z.
struct View {
  double x, y, distance, fov;  // degrees, vertical
  int width, height;
  std::string camera() const {
    return "eye=" + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(distance) +
           ";look=" + std::to_string(x) + "," + std::to_string(y) + ",0;up=0,1,0;fov=" + std::to_string(fov);
  }
  // Pixel of a point, y down.
  glm::dvec2 pixelOf(glm::dvec3 p) const {
    const double perMetre = 0.5 * height / ((distance - p.z) * std::tan(0.5 * fov * M_PI / 180));
    return {0.5 * width + (p.x - x) * perMetre, 0.5 * height - (p.y - y) * perMetre};
  }
};

struct Planes {
  ExrDocument document;
  float at(const char* name, int x, int y) const {
    for (const ExrPart& part : document.parts)
      if (const ExrChannel* channel = part.find(name))
        return channel->at(static_cast<std::size_t>(y - part.data.y0) * static_cast<std::size_t>(part.data.width()) +
                           static_cast<std::size_t>(x - part.data.x0));
    ADD_FAILURE() << "no channel " << name;
    return 0.0f;
  }
  glm::dvec3 rgb(int x, int y) const { return {at("R", x, y), at("G", x, y), at("B", x, y)}; }
  // Mean over the pixels between two points.
  glm::dvec3 mean(const View& view, glm::dvec3 low, glm::dvec3 high) const {
    const glm::dvec2 a = view.pixelOf(low), b = view.pixelOf(high);
    glm::dvec3 sum(0.0);
    int count = 0;
    for (int y = static_cast<int>(std::ceil(b.y)); y < static_cast<int>(a.y); ++y)
      for (int x = static_cast<int>(std::ceil(a.x)); x < static_cast<int>(b.x); ++x, ++count) sum += rgb(x, y);
    EXPECT_GT(count, 0);
    return sum / static_cast<double>(std::max(count, 1));
  }
};

// `gbuffer` of a sheet's opaque part and `composite` of its transparent part over it; what both leave.
struct Sheet {
  View view;
  std::string scene, folder;
  Planes opaque, picture;

  Sheet(const std::string& name, const View& seen, const std::string& environment,
        const std::vector<std::string>& more = {})
      : view(seen), scene(assets() + "/gltf/" + name + ".glb"), folder(freshFolder("sheet_" + name)) {
    const std::string size = std::to_string(view.width) + "x" + std::to_string(view.height);
    const std::vector<std::string> shared = {"--camera", view.camera(), "--environment", environment};
    std::vector<std::string> gbuffer = {"gbuffer",     scene, "-o",        folder + "/opaque.exr",
                                        "--size",      size,  "--samples", "1",
                                        "--ao-radius", "0",   "--shadows", "off"};
    std::vector<std::string> composite = {"composite", folder + "/opaque.exr", scene, "-o", folder + "/out.exr", "--aa",
                                          "1"};
    for (std::vector<std::string>* arguments : {&gbuffer, &composite}) {
      arguments->insert(arguments->end(), shared.begin(), shared.end());
      if (arguments == &composite) arguments->insert(arguments->end(), more.begin(), more.end());
      const Ended ended = runProgram(*arguments);
      EXPECT_EQ(ended.code, 0) << name << ": " << ended.err;
    }
    opaque.document = readExr(folder + "/opaque.exr");
    picture.document = readExr(folder + "/out.exr");
    std::size_t hits = 0, changed = 0;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const glm::dvec3 after = picture.rgb(x, y), before = opaque.rgb(x, y);
        EXPECT_TRUE(std::isfinite(after.r + after.g + after.b)) << name << " at " << x << ", " << y;
        hits += std::isfinite(opaque.at("Z", x, y)) ? 1 : 0;
        changed += after != before ? 1 : 0;
      }
    std::printf("[ figure ] %s: %dx%d, %zu pixels opaque, %zu changed by what is transparent\n", name.c_str(),
                view.width, view.height, hits, changed);
  }
};

#define NEED_ASSETS() \
  if (assets().empty()) GTEST_SKIP() << "no ../shared/assets beside the checkout"

TEST(Sheets, AlphaModesCutWhereTheLabelsSay) {
  NEED_ASSETS();
  const Sheet sheet("AlphaBlendModeTest", {0, 1.1, 7, 30, 320, 120}, "1,1,1");
  // Alpha falls from a pane's foot to its head; frames are opaque. Rows that the cut leaves, counted alike on a render
  // of four times the size, averaged.
  const struct {
    double x, cutoff;
    int rows;
  } panes[] = {{0.0, 0.25, 40}, {1.5, 0.5, 28}, {3.0, 0.75, 15}};
  constexpr double foot = 0.1, head = 1.97;
  for (const auto& pane : panes) {
    const glm::dvec2 left = sheet.view.pixelOf({pane.x - 0.35, foot, 0}),
                     right = sheet.view.pixelOf({pane.x + 0.35, head, 0});
    int covered = 0, rows = 0;
    for (int y = static_cast<int>(std::round(right.y)); y < static_cast<int>(std::round(left.y)); ++y, ++rows) {
      int changed = 0, columns = 0;
      for (int x = static_cast<int>(left.x); x < static_cast<int>(right.x); ++x, ++columns)
        changed += glm::length(sheet.picture.rgb(x, y) - sheet.opaque.rgb(x, y)) > 0.05 ? 1 : 0;
      covered += 2 * changed > columns ? 1 : 0;
    }
    const double share = static_cast<double>(covered) / rows;
    std::printf("[ figure ] cutoff %.2f: %.2f of the pane is left, %d of %d rows\n", pane.cutoff, share, covered, rows);
    EXPECT_NEAR(covered, pane.rows, 1);
  }
}

TEST(Sheets, RoughnessBlursMoreFromLeftToRightAndAirNever) {
  NEED_ASSETS();
  const Sheet sheet("TransmissionRoughnessTest", {0.2, 0, 2, 24, 320, 220}, "1,1,1");
  const std::string planes = sheet.folder + "/planes.exr";
  const Ended ended = runProgram({"accumulate", sheet.folder + "/opaque.exr", sheet.scene, "-o", planes, "--camera",
                                  sheet.view.camera(), "--environment", "1,1,1"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Planes sums{readExr(planes)};
  constexpr int cells = 9;
  const struct {
    const char* name;
    double y;
  } rows[] = {{"1.33", -0.11}, {"1.5", 0.0}, {"1.76", 0.11}, {"2.42", 0.22}};
  const auto cellX = [](int i) { return -0.29 + 0.98 * (i + 0.5) / cells; };
  for (const auto& row : rows) {
    double before = -1.0;
    std::printf("[ figure ] ior %s: spread in pixels", row.name);
    for (int i = 0; i < cells; ++i) {
      const glm::dvec2 at = sheet.view.pixelOf({cellX(i), row.y, 0.02});
      const double spread =
          std::sqrt(static_cast<double>(sums.at("oit.D2", static_cast<int>(at.x), static_cast<int>(at.y))));
      std::printf(" %.2f", spread);
      EXPECT_GT(spread, before) << row.name << ", cell " << i;
      before = spread;
    }
    std::printf("\n");
  }
  // What the eye sees: contrast inside the cells.
  const auto contrast = [&](int cell, double y) {
    double sum = 0, squares = 0;
    int count = 0;
    const glm::dvec2 a = sheet.view.pixelOf({cellX(cell) - 0.035, y - 0.03, 0.02}),
                     b = sheet.view.pixelOf({cellX(cell) + 0.035, y + 0.03, 0.02});
    for (int py = static_cast<int>(b.y); py <= static_cast<int>(a.y); ++py)
      for (int px = static_cast<int>(a.x); px <= static_cast<int>(b.x); ++px, ++count) {
        const double value = sheet.picture.rgb(px, py).g;
        sum += value;
        squares += value * value;
      }
    return std::sqrt(std::max(squares / count - sum * sum / (static_cast<double>(count) * count), 0.0));
  };
  double glass = 0, rough = 0, airSmooth = 0, airRough = 0;
  for (int i = 0; i < 2; ++i) {
    glass += contrast(i, 0.0) / 2;
    rough += contrast(cells - 1 - i, 0.0) / 2;
    airSmooth += contrast(i, -0.22) / 2;
    airRough += contrast(cells - 1 - i, -0.22) / 2;
  }
  std::printf("[ figure ] contrast: glass %.4f smooth, %.4f rough; air %.4f, %.4f\n", glass, rough, airSmooth,
              airRough);
  EXPECT_LT(rough, 0.5 * glass);
  EXPECT_GT(airRough, 0.5 * airSmooth);
}

TEST(Sheets, AttenuationRowsMatchTheSampleColours) {
  NEED_ASSETS();
  const Sheet sheet("AttenuationTest", {-1, 1, 22, 46, 240, 240}, "0.8,0.8,0.8");
  double worst = 0;
  for (const auto& [x, sample] : {std::pair{0.0, 6.0}, std::pair{2.5, 6.0}, std::pair{6.0, 6.0}}) {
    const auto patch = [&](double y, double z) {
      return sheet.picture.mean(sheet.view, {x - 0.3, y - 0.3, z}, {x + 0.3, y + 0.3, z});
    };
    const glm::dvec3 wanted = patch(sample, 0.0);
    const double thick = x == 0.0 ? 1.0 : x == 2.5 ? 1.5 : 2.0;
    const double front[] = {thick, thick, thick, 1.0};
    for (int row = 0; row < 4; ++row) {
      const glm::dvec3 found = patch(3.0 - 3.0 * row, front[row]);
      const glm::dvec3 off = glm::abs(found - wanted);
      worst = std::max({worst, off.r, off.g, off.b});
    }
  }
  std::printf("[ figure ] attenuation: rows differ from the sample colours by at most %.3f\n", worst);
  EXPECT_LT(worst, 0.08);  // grid lines behind the patches, and what the faces reflect
}

TEST(Sheets, EmissionDoublesFromCubeToCube) {
  NEED_ASSETS();
  const Sheet sheet("EmissiveStrengthTest", {0, 0, 20, 30, 240, 120}, "0,0,0");
  double before = 0;
  for (const double x : {-6.0, -3.0, 0.0, 3.0, 6.0}) {
    const double found = [&] {
      const glm::dvec3 m = sheet.picture.mean(sheet.view, {x - 0.2, -0.2, 0.5}, {x + 0.2, 0.2, 0.5});
      return std::max({m.r, m.g, m.b});
    }();
    std::printf("[ figure ] emission %.4f\n", found);
    if (before > 0) {
      EXPECT_NEAR(found / before, 2.0, 1e-3);
    }
    before = found;
  }
}

TEST(Sheets, TransformedTexturesMatchTheSamplesBesideThem) {
  NEED_ASSETS();
  const Sheet sheet("TextureTransformMultiTest", {0, 0, 4, 30, 256, 256}, "1,1,1");
  const struct {
    const char* name;
    double y;
  } rows[] = {{"base colour", 0.65}, {"emission", 0.4}, {"normal", 0.15}, {"unlit", -0.6}};
  for (const auto& row : rows) {
    const auto quad = [&](const char* r, const char* g, const char* b, double x, int part) {
      // Quarters of the quad: a wrong turn shows.
      const double x0 = x + 0.02 + 0.08 * (part % 2), y0 = row.y + 0.02 + 0.08 * (part / 2);
      const glm::dvec2 low = sheet.view.pixelOf({x0, y0, 0}), high = sheet.view.pixelOf({x0 + 0.08, y0 + 0.08, 0});
      glm::dvec3 sum(0.0);
      int count = 0;
      for (int py = static_cast<int>(std::round(high.y)); py < static_cast<int>(std::round(low.y)); ++py)
        for (int px = static_cast<int>(std::round(low.x)); px < static_cast<int>(std::round(high.x)); ++px, ++count)
          sum += glm::dvec3(sheet.opaque.at(r, px, py), sheet.opaque.at(g, px, py), sheet.opaque.at(b, px, py));
      return sum / static_cast<double>(count);
    };
    const bool normals = row.y == 0.15;
    double worst = 0, range = 0;
    for (int part = 0; part < 4; ++part)
      for (const double x : {0.0, 0.25}) {
        const auto of = [&](double at, int which) {
          return normals ? quad("N.X", "N.Y", "N.Z", at, which) : quad("R", "G", "B", at, which);
        };
        const glm::dvec3 off = glm::abs(of(x, part) - of(0.5, part));
        worst = std::max({worst, off.r, off.g, off.b});
        range = std::max(range, glm::length(of(0.5, part) - of(0.5, 3 - part)));
      }
    std::printf("[ figure ] texture transform, %s: differs from the sample by %.3f, its quarters by %.3f\n", row.name,
                worst, range);
    EXPECT_LT(worst, 0.06) << row.name;
    EXPECT_GT(range, 4 * worst) << row.name << ": a wrong turn must show";
  }
}

TEST(Sheets, TheOthersComposite) {
  NEED_ASSETS();
  const Sheet cubes("SimpleInstancing", {0, 0, 40, 40, 128, 128}, "1,1,1");
  const Sheet pane("GlassBrokenWindow", {0, 0.26, 0.9, 36, 96, 96}, "0.8,0.9,1");
  // Through the hole nothing changes; the pane tints.
  const glm::dvec2 hole = pane.view.pixelOf({0.0, 0.255, 0}), glass = pane.view.pixelOf({-0.15, 0.4, 0});
  EXPECT_EQ(pane.picture.rgb(static_cast<int>(hole.x), static_cast<int>(hole.y)),
            pane.opaque.rgb(static_cast<int>(hole.x), static_cast<int>(hole.y)));
  EXPECT_NE(pane.picture.rgb(static_cast<int>(glass.x), static_cast<int>(glass.y)),
            pane.opaque.rgb(static_cast<int>(glass.x), static_cast<int>(glass.y)));
  const Sheet vase("GlassVaseFlowers", {0.055, 0.095, 0.55, 30, 120, 100}, "0.8,0.9,1", {"--refract", "thickness"});
  const Sheet transmission("TransmissionTest", {-0.1, 0.08, 2.4, 30, 128, 96}, "1,1,1");
}

}  // namespace
}  // namespace pellucid
