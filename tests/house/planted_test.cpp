// Each rule finds a violation that is planted for it, and leaves its look-alikes alone.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/house/rules.h"

namespace pellucid::test {
namespace {

std::size_t arrows(const std::string& path, const std::string& text) {
  return againstArrows({path, text}).size();
}
std::size_t library(const std::string& path, const std::string& text) {
  return libraryOutsideItsRoom({path, text}).size();
}
std::size_t shared(const std::string& text) {
  return againstSharedText({"shaders/shared/planted.glsl", text}).size();
}

TEST(Planted, EveryArrowBackwardsIsFound) {
  EXPECT_EQ(arrows("shaders/shading.h", "#include \"gbuffer/image.h\"\n"), 1u);
  EXPECT_EQ(arrows("shaders/gl/a.frag", "#include \"composite/fold.h\"\n"), 1u);
  EXPECT_EQ(arrows("gbuffer/image.h", "#include \"composite/fold.h\"\n"), 1u);
  EXPECT_EQ(arrows("gbuffer/image.h", "  #  include \"engine_bridge/scene/scene.h\"\n"), 1u);
  EXPECT_EQ(arrows("engine_bridge/gl/pass.cpp", "#include \"composite/fold.h\"\n"), 1u);
  EXPECT_EQ(arrows("composite/fold.cpp", "#include \"engine_bridge/scene/scene.h\"\n"), 1u);
  EXPECT_EQ(arrows("composite/study/table.cpp", "#include \"composite/cli/options.h\"\n"), 1u);
  EXPECT_EQ(arrows("composite/fold.cpp", "#include \"composite/pipeline/plan.h\"\n"), 1u);
  EXPECT_EQ(arrows("engine_bridge/gl/pass.cpp", "#include \"composite/pipeline/plan.h\"\n"), 1u);
  EXPECT_EQ(arrows("composite/pipeline/plan.cpp", "#include \"composite/cli/options.h\"\n"), 1u);
  EXPECT_EQ(arrows("composite/cli/app.cpp", "#include \"tests/support/random.h\"\n"), 1u);
  EXPECT_EQ(arrows("composite/cli/app.cpp", "#include \"samples/generate/glb.h\"\n"), 1u);
  EXPECT_EQ(arrows("samples/bars/bars.cpp", "#include \"tests/support/random.h\"\n"), 1u);
}

TEST(Planted, DetoursAreFound) {
  EXPECT_EQ(arrows("gbuffer/image.h", "#include <composite/fold.h>\n"), 1u);
  EXPECT_EQ(arrows("gbuffer/image.h", "#include \"gbuffer/../composite/fold.h\"\n"), 1u);
  EXPECT_EQ(arrows("gbuffer/image.h", "#include \"../composite/fold.h\"\n"), 1u);
  EXPECT_EQ(arrows("engine_bridge/gl/pass.cpp", "#include \"gl/pass.h\"\n"), 1u);
  EXPECT_EQ(arrows("attic/old.h", "#include <vector>\n"), 1u);
}

TEST(Planted, ArrowsForwardsAreAllowed) {
  EXPECT_EQ(arrows("gbuffer/image.h", "#include \"shaders/shading.h\"\n#include <vector>\n#include <tbb/info.h>\n"),
            0u);
  EXPECT_EQ(arrows("shaders/gl/a.frag", "#include \"shared/resolve.glsl\"\n#include \"gl/blocks.glsl\"\n"), 0u);
  EXPECT_EQ(
      arrows("composite/cli/app.cpp", "#include \"engine_bridge/scene/scene.h\"\n#include \"composite/fold.h\"\n"), 0u);
  EXPECT_EQ(arrows("tests/gbuffer/a_test.cpp", "#include \"exr_files.h\"\n"), 0u);
  EXPECT_EQ(arrows("composite/fold.cpp", "// #include \"engine_bridge/scene/scene.h\"\n"), 0u);
}

TEST(Planted, LibrariesOutsideTheirRoomAreFound) {
  EXPECT_EQ(library("composite/fold.cpp", "#include <epoxy/gl.h>\n"), 1u);
  EXPECT_EQ(library("engine_bridge/scene/a.cpp", "#include <EGL/egl.h>\n"), 1u);
  EXPECT_EQ(library("engine_bridge/gl/a.cpp", "#include <embree3/rtcore.h>\n"), 1u);
  EXPECT_EQ(library("composite/fold.cpp", "#include <OpenEXR/ImfHeader.h>\n"), 1u);
  EXPECT_EQ(library("engine_bridge/gl/a.cpp", "#include <epoxy/gl.h>\n"), 0u);
  EXPECT_EQ(library("tests/gl/a_test.cpp", "#include <epoxy/gl.h>\n"), 0u);
}

TEST(Planted, DirectivesInSharedTextAreFound) {
  EXPECT_EQ(shared("#ifdef GL_ES\n#endif\n"), 2u);
  EXPECT_EQ(shared("#define TWO 2\n"), 1u);
  EXPECT_EQ(shared("#include \"gl/blocks.glsl\"\n"), 1u);
  EXPECT_EQ(shared("#pragma once\n#include \"shared/numeric.glsl\"\n// #ifdef in prose\n"), 0u);
}

TEST(Planted, DoubleLiteralsAreFound) {
  for (const char* literal : {"0.5", "1.", ".5", "1e-3", "2.5e3", "0.5 * 2.0f", "1.0e+3"})
    EXPECT_EQ(shared(std::string("float x = ") + literal + ";\n"), 1u) << literal;
  for (const char* literal :
       {"0.5f", "1.f", "1e-3f", "-2.12194440e-4f", "3", "0x3f800000", "12u", "v.x", "a2.y", "v1.r * 2.0f", "0x1e5u"})
    EXPECT_EQ(shared(std::string("float x = ") + literal + ";\n"), 0u) << literal;
}

TEST(Planted, SwizzlesAreFound) {
  EXPECT_EQ(shared("vec3 a = v.rgb;\n"), 1u);
  EXPECT_EQ(shared("vec2 a = f(v).xy;\n"), 1u);
  EXPECT_EQ(shared("vec2 a = rows[1] . st;\n"), 1u);
  EXPECT_EQ(shared("float a = v.r + v.x;\n"), 0u);
  EXPECT_EQ(shared("float a = layer.radiance.r + surface.baseColor.b;\n"), 0u);
  EXPECT_EQ(shared("// the planes are A.rgb and W.rgb\n"), 0u);
}

TEST(Planted, ReservedWordsAreFound) {
  for (const char* word : {"sample", "input", "output", "filter", "common", "active", "half", "buffer", "shared",
                           "flat", "patch", "and", "or", "not", "new", "near", "far"})
    EXPECT_EQ(shared(std::string("float ") + word + " = 1.0f;\n"), 1u) << word;
  EXPECT_EQ(shared("float rangeNear = 1.0f;  // near, not far\n"), 0u);
}

TEST(Planted, TheRestOfTheSharedRulesAreFound) {
  EXPECT_EQ(shared("double x = 1;\n"), 1u);
  EXPECT_EQ(againstSharedText({"shaders/shared/exact_sums.glsl", "double x = 1;\n"}).size(), 0u);
  EXPECT_EQ(shared("PLD_FN void f(inout float x) {}\n"), 1u);
  EXPECT_EQ(shared("vec4 c = texture(t, uv);\n"), 1u);
  EXPECT_EQ(shared("if (a) discard;\n"), 1u);
  EXPECT_EQ(shared("float w = fwidth(x);\n"), 1u);
}

TEST(Planted, LinesAreCountedThroughComments) {
  const Violations found =
      againstSharedText({"shaders/shared/planted.glsl", "/* one\n two */\n// three\nfloat x = 0.5;\n"});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].rfind("shaders/shared/planted.glsl:4: ", 0), 0u) << found[0];
}

TEST(Planted, TwoTypesOfOneNameAreFound) {
  const auto twice = [](const char* first, const char* second) {
    return definedTwice({{"samples/a.h", first}, {"samples/b.h", second}}).size();
  };
  const char* card = "namespace pellucid::samples {\nstruct Card {\n};\n}  // namespace pellucid::samples\n";
  EXPECT_EQ(twice(card, card), 1u);
  EXPECT_EQ(
      twice(
          card,
          "namespace pellucid::samples {\nclass Card final : public Paper {\n};\n}  // namespace pellucid::samples\n"),
      1u);
  EXPECT_EQ(twice(card, "namespace pellucid::test {\nstruct Card {\n};\n}  // namespace pellucid::test\n"), 0u);
  EXPECT_EQ(twice(card,
                  "namespace pellucid::samples {\nnamespace {\nstruct Card {\n};\n}  // namespace\n}  // namespace "
                  "pellucid::samples\n"),
            0u);
  EXPECT_EQ(
      twice(
          card,
          "namespace pellucid::samples {\nstruct Card;\nstruct Card::Edge {\n};\n}  // namespace pellucid::samples\n"),
      0u);
}

TEST(Planted, TwoHeadersOfOneNameAreFound) {
  const auto found = [](const char* first, const char* second) {
    return headersNamedTwice({{first, ""}, {second, ""}}).size();
  };
  EXPECT_EQ(found("gbuffer/image.h", "engine_bridge/gl/image.h"), 1u);
  EXPECT_EQ(found("gbuffer/image.h", "gbuffer/image.cpp"), 0u);
  EXPECT_EQ(found("gbuffer/image.cpp", "engine_bridge/image.cpp"), 0u);
  EXPECT_EQ(found("gbuffer/image.h", "gbuffer/an_image.h"), 0u);
}

TEST(Planted, CirclesAreFound) {
  const auto include = [](const char* path) { return std::string("#include \"room/") + path + "\"\n"; };
  const auto circles = [](const std::vector<SourceFile>& files) { return circlesIn("room", files).size(); };
  // Straight, by way of a source, over three parts.
  EXPECT_EQ(circles({{"room/a.h", include("b.h")}, {"room/b.h", include("a.h")}}), 1u);
  EXPECT_EQ(circles({{"room/a.h", include("b.h")}, {"room/b.h", ""}, {"room/b.cpp", include("b.h") + include("a.h")}}),
            1u);
  EXPECT_EQ(circles({{"room/a.h", include("b.h")}, {"room/b.cpp", include("c.h")}, {"room/c.h", include("a.h")}}), 1u);
  // A class whose members are defined in another part.
  const std::string type = "struct Pass {\n  void end();\n};\n", member = "void Pass::end() {\n}\n";
  EXPECT_EQ(circles({{"room/a.h", type}, {"room/a_end.cpp", include("a.h") + member}}), 1u);
  EXPECT_EQ(circles({{"room/a.h", type}, {"room/a.cpp", include("a.h") + member}}), 0u);
  // Two parts of one, and a header that its own source includes.
  EXPECT_EQ(circles({{"room/a.h", ""}, {"room/b.h", include("a.h")}, {"room/c.cpp", include("a.h") + include("b.h")}}),
            0u);
  // Elsewhere.
  EXPECT_EQ(circles({{"rooms/a.h", include("b.h")}, {"rooms/b.h", include("a.h")}}), 0u);
}

TEST(Planted, AMissingOrEmptyReadmeIsFound) {
  const std::filesystem::path top = std::filesystem::path(PELLUCID_BINARY_DIR) / "test-files" / "planted-readme";
  std::filesystem::remove_all(top);
  for (const char* folder : {"gbuffer", "samples/bars", "samples/generate"})
    std::filesystem::create_directories(top / folder);
  const auto write = [&](const char* folder, const char* text) { std::ofstream(top / folder / "README.md") << text; };
  EXPECT_EQ(roomsWithoutReadme(top.string()).size(), 0u);  // empty folders are no rooms
  for (const char* file : {"gbuffer/image.h", "samples/bars/bars.cpp", "samples/generate/glb.h"})
    std::ofstream(top / file) << "//\n";
  EXPECT_EQ(roomsWithoutReadme(top.string()).size(), 4u);  // the top, gbuffer, samples, samples/bars
  write("", "top");
  write("samples", "samples");
  write("samples/bars", "bars");
  write("gbuffer", "");
  EXPECT_EQ(roomsWithoutReadme(top.string()).size(), 1u);
  write("gbuffer", "records");
  EXPECT_EQ(roomsWithoutReadme(top.string()).size(), 0u);
}

}  // namespace
}  // namespace pellucid::test
