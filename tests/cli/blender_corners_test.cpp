// Whether things lie where the picture shows them, frame by frame: corners from the camera and the pose that the
// program takes from the animated glTF, against corners measured in Blender's pictures. Skipped without
// ../shared/assets.
#include <fstream>
#include <nlohmann/json.hpp>

#include "composite/pipeline/shot.h"
#include "tests/cli/blender_shot.h"
#include "tests/support/outline_fit.h"

namespace pellucid {
namespace {

using namespace test;

constexpr double kPi = 3.14159265358979323846;
constexpr double kBound = 0.1;  // pixels

// Blender's default, 1.5 px to each side; its formula is in the assets' facts.json.
FilterProfile blenderFilter() {
  return {1.5, [](double x) {
            const double u = 2.0 * kPi * (x / 3.0 + 0.5);
            return 0.35875 - 0.48829 * std::cos(u) + 0.14128 * std::cos(2.0 * u) - 0.01168 * std::cos(3.0 * u);
          }};
}

class BlenderCorners : public BlenderShot {
 protected:
  std::unique_ptr<Shot> shotAt(int frame, double framesLate = 0.0) const {
    ShotRequest request;
    request.opaque = from + "opaque." + std::to_string(frame) + ".exr";
    request.inputs = {from + "transparent_unlit.glb"};
    request.camera = NamedCamera{"cam"};
    if (framesLate != 0.0) request.time.offset = framesLate / 24.0;
    Journal journal;
    return loadShot(request, false, journal);
  }
  // World positions of the corners of the boxes that stand in the picture, by name.
  std::map<std::string, std::vector<glm::dvec3>> boxes() const {
    std::map<std::string, std::vector<glm::dvec3>> corners;
    std::ifstream file(from + "facts.json");
    const nlohmann::json facts = nlohmann::json::parse(file);
    for (const auto& [name, places] : facts["opaque_corners"].items())
      for (const auto& place : places)  // Blender's z is up
        corners[name].emplace_back(place[0].get<double>(), place[2].get<double>(), -place[1].get<double>());
    return corners;
  }
  static std::vector<glm::dvec3> placed(const Scene& scene, const std::string& node) {
    std::vector<glm::dvec3> places;
    for (const Instance& instance : scene.instances) {
      if (instance.node != node) continue;
      for (const Vertex& vertex : scene.primitives[static_cast<std::size_t>(instance.primitive)].vertices)
        places.emplace_back(instance.worldFromObject * glm::dvec4(glm::dvec3(vertex.position), 1.0));
    }
    return places;
  }
  static MeasuredOutline measured(const Shot& shot, const Image<glm::vec4>& picture,
                                  const std::vector<glm::dvec3>& places) {
    std::vector<glm::dvec2> pixels;
    for (const glm::dvec3& place : places)
      pixels.push_back(project(shot.camera, shot.opaque.gbuffer.display, place).pixel);
    return measureOutline(picture, hullOf(pixels), blenderFilter());
  }
};

struct Worst {
  int corners = 0, edges = 0;
  double corner = 0.0, edge = 0.0, uncertainty = 0.0;
  void add(const MeasuredOutline& outline) {
    corners += static_cast<int>(outline.corners.size());
    edges += outline.edges;
    edge = std::max(edge, outline.worstEdge);
    for (const MeasuredCorner& one : outline.corners) {
      corner = std::max(corner, glm::length(one.apart));
      uncertainty = std::max(uncertainty, one.uncertainty);
    }
  }
};

// What stands, by the animated camera.
TEST_F(BlenderCorners, OfStandingBoxesInEveryFrame) {
  for (int frame = 1001; frame <= 1008; ++frame) {
    const std::unique_ptr<Shot> shot = shotAt(frame);
    Worst worst;
    for (const auto& [name, places] : boxes()) worst.add(measured(*shot, shot->opaque.gbuffer.beauty, places));
    std::printf(
        "[ figure ] %d: %d corners, at most %.4f px from the picture's (uncertain by %.4f); %d edges, %.4f px\n", frame,
        worst.corners, worst.corner, worst.uncertainty, worst.edges, worst.edge);
    EXPECT_GE(worst.corners, 2) << frame;
    EXPECT_LE(worst.corner, kBound) << frame;
    EXPECT_LE(worst.edge, kBound) << frame;
    EXPECT_LE(worst.uncertainty, 0.1 * kBound) << frame << ": a measure that could not tell";
  }
}

// What moves, by its own animation and the camera's. Smoke and leaves before or behind it hide some of its edges.
TEST_F(BlenderCorners, OfTheTurningPane) {
  Worst all;
  int frames = 0;
  for (int frame = 1001; frame <= 1008; ++frame) {
    const std::unique_ptr<Shot> shot = shotAt(frame);
    const std::vector<glm::dvec3> places = placed(shot->scene, "pane");
    ASSERT_GE(places.size(), 8u);
    const Image<glm::vec4> picture = beauty(from + "flat_truth." + std::to_string(frame) + ".exr");
    Worst worst;
    worst.add(measured(*shot, picture, places));
    std::printf("[ figure ] %d: %d corners, at most %.4f px from the picture's; %d edges, %.4f px\n", frame,
                worst.corners, worst.corner, worst.edges, worst.edge);
    EXPECT_LE(worst.corner, kBound) << frame;
    EXPECT_LE(worst.edge, kBound) << frame;
    frames += worst.edges > 0;
    all.corners += worst.corners;
  }
  EXPECT_GE(frames, 5);
  EXPECT_GE(all.corners, 3);
}

// So the measure can fail: it tells the camera of a twentieth of a frame later.
TEST_F(BlenderCorners, ACameraThatIsLateIsSeen) {
  const std::unique_ptr<Shot> right = shotAt(1001), late = shotAt(1001, 0.05);
  Worst before, after;
  for (const auto& [name, places] : boxes()) {
    before.add(measured(*right, right->opaque.gbuffer.beauty, places));
    after.add(measured(*late, late->opaque.gbuffer.beauty, places));
  }
  std::printf("[ figure ] a twentieth of a frame late: corners %.4f px away, %.4f at the frame\n", after.corner,
              before.corner);
  EXPECT_GE(after.corners, 2);
  EXPECT_GT(after.corner, kBound);
}

}  // namespace
}  // namespace pellucid
