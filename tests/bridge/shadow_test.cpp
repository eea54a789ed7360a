// Shadow maps through the C library against those of the C++ rooms: the same casters, texel by texel and point by
// point.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "engine_bridge/gl/shadow_pass.h"
#include "tests/bridge/shadow_casters.h"
#include "tests/shadow/scenes.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

using Form = ShadowMapSettings::Form;

// No edge that runs through the middle of texels: what they belong to hangs on the last bit. A lamp that is 3 m from
// the farthest corner, straight above, and casters 4 m wide: units of depth that float holds.
Scene sceneOf(bool coloured) {
  Scene scene;
  Primitive pane = quad(1, 2);
  const glm::vec2 corners[] = {{-2, 1.4731f}, {2, 2}, {1.7213f, -1.6937f}, {-1.5337f, -2}};
  for (std::size_t i = 0; i < 4; ++i) pane.vertices[i].position = {corners[i].x, 1, corners[i].y};
  add(scene, pane, glass(coloured ? glm::vec3(.8f, .5f, .3f) : glm::vec3(.6f)));
  Primitive tilted = quad(1.25f, .5f);
  for (Vertex& vertex : tilted.vertices) {
    vertex.position += glm::vec3(.1f, .5f * vertex.position.x + .125f * vertex.position.z, .07f);
    vertex.normal = glm::normalize(glm::vec3(-.5f, 1.0f, -.125f));
  }
  add(scene, tilted, glass(coloured ? glm::vec3(.9f, .5f, .1f) : glm::vec3(.7f), 1.3f, true));
  Light lamp = sun({0, -1, 0}), spot = lamp;
  lamp.kind = LightKind::point;
  spot.kind = LightKind::spot;
  lamp.position = spot.position = {0, 2, 0};
  spot.innerCone = .5f;
  spot.outerCone = .9f;
  scene.lights = {sun({0, -1, 0}), spot, lamp};
  return scene;
}

Camera besideIt() {
  Camera camera;
  camera.viewFromWorld[3] = {0, -1, -4, 1};
  return camera;
}

struct FormPair {
  Form room;
  pld_shadow_form library;
  const char* name;
};
const FormPair kForms[] = {{Form::variance, PLD_SHADOW_VARIANCE, "variance"},
                           {Form::published, PLD_SHADOW_PUBLISHED, "published"},
                           {Form::naive, PLD_SHADOW_NAIVE, "naive"},
                           {Form::stratified, PLD_SHADOW_STRATIFIED, "stratified"},
                           {Form::corrected, PLD_SHADOW_CORRECTED, "corrected"}};

// Rooms halve the edge where there are six faces; the library has one for all, so lights are tried one by one.
TEST(BridgeShadow, TheMapsAreThoseOfTheRooms) {
  GlContext context;
  Host host(16, 16);
  const Camera camera = besideIt();
  for (const bool coloured : {true, false})
    for (const FormPair& form : kForms)
      for (std::size_t light = 0; light < 3; ++light) {
        if (!coloured && light != 0) continue;
        const Scene all = sceneOf(coloured);
        Scene scene = all;
        scene.lights = {all.lights[light]};
        const int faces = light == 2 ? 6 : 1, size = 512, edge = faces == 6 ? size / 2 : size,
                  channels = coloured ? 3 : 1;
        ShadowMapSettings settings;
        settings.form = form.room;
        settings.size = size;
        const ShadowMaps expected = renderShadowMaps(context, scene, camera, nullptr, settings);
        ASSERT_EQ(expected.faces.size(), static_cast<std::size_t>(faces));
        glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
        pld_pass* pass = host.create(host.info());
        ASSERT_NE(pass, nullptr);
        const pld_shadow_info info = shadowInfo(form.library, edge, 1, faces, coloured);
        ASSERT_EQ(pld_shadow_resize(pass, &info), PLD_OK) << pld_message(pass);
        for (const pld_shadow_view& view : shadowViews(scene, camera, 0, 0, size))
          drawCasters(pass, view, scene, 0, size);
        const bool filtered = form.library <= PLD_SHADOW_PUBLISHED;
        const int kept = filtered ? edge / 4 : edge;
        const std::vector<float> found = shadowTexels(pass, kept, faces * channels);
        ASSERT_EQ(expected.texels.size() * 4, found.size());
        // The rooms keep a texel's channels side by side, the library in layers.
        ShadowMaps ours = expected;
        for (int f = 0; f < faces; ++f)
          for (int i = 0; i < kept * kept; ++i)
            for (int c = 0; c < channels; ++c)
              std::memcpy(&ours.texels[static_cast<std::size_t>((f * kept * kept + i) * channels + c)],
                          &found[std::size_t{4} * static_cast<std::size_t>((f * channels + c) * kept * kept + i)],
                          sizeof(glm::vec4));
        std::size_t differ = 0, covered = 0, apart = 0;
        for (std::size_t i = 0; i < ours.texels.size(); ++i) {
          const int row = static_cast<int>(i) / (kept * channels) % kept;
          // Rooms draw what they filter with seven rows more on either side, with casters beyond the face: no lookup
          // goes there.
          if (filtered && (row < 2 || row >= kept - 2)) continue;
          const glm::vec4 room = expected.texels[i];
          covered += room.y > 0.0f;
          differ += std::memcmp(&room, &ours.texels[i], sizeof(room)) != 0;
          apart += glm::length(room - ours.texels[i]) > 4e-6f;
        }
        std::printf("%s, %s, light %zu: %zu texels, %zu with casters, %zu of other bits, %zu further apart than 4e-6\n",
                    form.name, coloured ? "coloured" : "grey", light, ours.texels.size(), covered, differ, apart);
        EXPECT_GT(covered, 1000u);
        // And so window coordinates round otherwise, in the last bits.
        EXPECT_EQ(apart, 0u);
        if (!filtered) {
          EXPECT_EQ(differ, 0u);
        }
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
        // What they say about points.
        Random random(1);
        std::vector<float> points;
        for (int i = 0; i < 1000; ++i) {
          const glm::vec4 point(camera.viewFromWorld * glm::dvec4(random.between(-1.5, 1.5), random.between(-.5, 2.5),
                                                                  random.between(-1.5, 1.5), 1.0));
          points.insert(points.end(), &point[0], &point[0] + 4);
        }
        for (const bool onOpaque : {false, true}) {
          const std::vector<float> answers = askShadows(pass, info, 0, points, onOpaque, light == 1 ? 330 : 450);
          int strays = 0, shadowed = 0;
          for (std::size_t i = 0; i < points.size(); i += 4) {
            const glm::vec3 point(points[i], points[i + 1], points[i + 2]),
                answer(answers[i], answers[i + 1], answers[i + 2]);
            const glm::vec3 v = onOpaque ? ours.onOpaque(0, point) : ours.visibility(0, point);
            shadowed += v != glm::vec3(1.0f);
            strays += glm::length(answer - v) > 1e-4f;
          }
          EXPECT_GT(shadowed, 100);
          // Where a point falls between two texels, or within the thinnest of slabs, rounding of the projection
          // decides.
          EXPECT_LE(strays, 12) << form.name << " " << light;
        }
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
        EXPECT_EQ(pld_destroy(&pass), PLD_OK);
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
        glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
      }
}

// What is kept of drawn texels, bit by bit, by the text that the rooms filter with: forms that share coins differ in
// nothing else.
TEST(BridgeShadow, TheFilterIsThatOfTheRooms) {
  GlContext context;
  Host host(16, 16);
  const Camera camera = besideIt();
  constexpr int size = 128, kept = size / 4;
  for (const bool coloured : {true, false}) {
    Scene scene = sceneOf(coloured);
    scene.lights.resize(1);
    pld_pass* pass = host.create(host.info());
    ASSERT_NE(pass, nullptr);
    const int channels = coloured ? 3 : 1;
    const pld_shadow_view view = shadowViews(scene, camera, 0, 0, size).at(0);
    pld_shadow_info info = shadowInfo(PLD_SHADOW_CORRECTED, size, 1, 1, coloured);
    ASSERT_EQ(pld_shadow_resize(pass, &info), PLD_OK) << pld_message(pass);
    drawCasters(pass, view, scene, 0, size);
    const std::vector<float> drawn = shadowTexels(pass, size, channels);
    info.form = PLD_SHADOW_VARIANCE;
    ASSERT_EQ(pld_shadow_resize(pass, &info), PLD_OK) << pld_message(pass);
    drawCasters(pass, view, scene, 0, size);
    const std::vector<float> filtered = shadowTexels(pass, kept, channels);
    const auto texel = [&](int c, int x, int y) {
      glm::vec4 found;
      std::memcpy(&found, &drawn[std::size_t{4} * static_cast<std::size_t>((c * size + y) * size + x)], sizeof(found));
      return found;
    };
    std::size_t differ = 0;
    for (int c = 0; c < channels; ++c)
      for (int y = 0; y < kept; ++y)
        for (int x = 0; x < kept; ++x) {
          glm::vec4 sum(0.0f);
          for (int j = -shading::PLD_SHADOW_TENT_REACH; j <= shading::PLD_SHADOW_TENT_REACH; ++j) {
            const int row = shading::tentMiddle(y) + j;
            if (row < 0 || row >= size) continue;
            glm::vec4 across(0.0f);
            for (int i = -shading::PLD_SHADOW_TENT_REACH; i <= shading::PLD_SHADOW_TENT_REACH; ++i) {
              const int column = shading::tentMiddle(x) + i;
              if (column >= 0 && column < size) across = shading::addToTent(across, i, texel(c, column, row));
            }
            sum = shading::addToTent(sum, j, across);
          }
          differ += std::memcmp(&sum, &filtered[std::size_t{4} * static_cast<std::size_t>((c * kept + y) * kept + x)],
                                sizeof(sum)) != 0;
        }
    std::printf("%s: %d filtered texels, %zu of other bits\n", coloured ? "coloured" : "grey", channels * kept * kept,
                differ);
    EXPECT_EQ(differ, 0u);
    pld_destroy(&pass);
  }
}

}  // namespace
}  // namespace pellucid::test
