// From a clean install prefix: what the library shows, and that others can build against it.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>

#include "engine_bridge/include/pellucid/pellucid.h"
#include "tests/support/program.h"
#include "tests/support/shell.h"

namespace pellucid::test {
namespace {

std::string installed() {
  const std::string folder =
      freshFolder(std::string("bridge-install-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  const Ended ended = shell("cmake --install '" PELLUCID_BINARY_DIR "' --prefix '" + folder + "/prefix'", folder);
  EXPECT_EQ(ended.code, 0) << ended.out;
  return folder;
}

TEST(BridgeInstall, TheLibraryShowsItsInterfaceAndNothingElse) {
  const std::string folder = installed();
  const Ended listed =
      shell("nm -D --defined-only --format=posix '" + folder + "/prefix/lib/libpellucid_c.so'", folder);
  ASSERT_EQ(listed.code, 0) << listed.out;
  std::set<std::string> shown, declared;
  std::istringstream lines(listed.out);
  for (std::string line; std::getline(lines, line);) shown.insert(line.substr(0, line.find(' ')));
  const std::string header =
      slurp(folder + "/prefix/include/pellucid/pellucid.h") + slurp(folder + "/prefix/include/pellucid/recipe.h");
  const std::regex function(R"(PLD_API [^;(]*?(pld_\w+)\()");
  for (std::sregex_iterator i(header.begin(), header.end(), function), end; i != end; ++i) declared.insert((*i)[1]);
  std::printf("libpellucid_c.so: %zu symbols shown, %zu declared\n", shown.size(), declared.size());
  EXPECT_EQ(shown, declared);
  EXPECT_EQ(declared.size(), 38u);
  const Ended needed = shell("objdump -p '" + folder + "/prefix/lib/libpellucid_c.so' | grep NEEDED", folder);
  for (const char* library : {"libGL", "libEGL", "libepoxy", "libOpen", "libfmt"})
    EXPECT_EQ(needed.out.find(library), std::string::npos) << needed.out;
}

TEST(BridgeInstall, AnOutsideCmakeProjectBuildsAndRenders) {
  if (sanitized()) GTEST_SKIP() << "a library built with a sanitizer wants programs built with it";
  const std::string folder = installed(), build = folder + "/cmake";
  const Ended built =
      shell("cmake -S '" PELLUCID_SOURCE_DIR "/tests/bridge/outside' -B '" + build +
                "' -DROOMS=ON -DCMAKE_PREFIX_PATH='" + folder + "/prefix' && cmake --build '" + build + "'",
            folder);
  ASSERT_EQ(built.code, 0) << built.out;
  const Ended drawn = shell("'" + build + "/outside' && '" + build + "/rooms'", folder);
  EXPECT_EQ(drawn.code, 0) << drawn.out;
  EXPECT_NE(drawn.out.find("rendered"), std::string::npos) << drawn.out;
  EXPECT_NE(drawn.out.find("composited"), std::string::npos) << drawn.out;
}

TEST(BridgeInstall, AnOutsidePkgConfigProjectBuildsAndRenders) {
  if (sanitized()) GTEST_SKIP() << "a library built with a sanitizer wants programs built with it";
  const std::string folder = installed();
  const std::string config = "PKG_CONFIG_PATH='" + folder + "/prefix/lib/pkgconfig' pkg-config --cflags --libs ";
  const Ended built = shell("cc -std=c99 -Wall -Wextra -Wpedantic -Werror -o '" + folder +
                                "/outside' '" PELLUCID_SOURCE_DIR "/tests/bridge/outside/outside.c' $(" + config +
                                "pellucid) -lEGL -lGL -lm -Wl,-rpath,'" + folder + "/prefix/lib'",
                            folder);
  ASSERT_EQ(built.code, 0) << built.out;
  const Ended drawn = shell("'" + folder + "/outside'", folder);
  EXPECT_EQ(drawn.code, 0) << drawn.out;
  EXPECT_NE(drawn.out.find("rendered"), std::string::npos) << drawn.out;
  const Ended version =
      shell("PKG_CONFIG_PATH='" + folder + "/prefix/lib/pkgconfig' pkg-config --modversion pellucid", folder);
  EXPECT_EQ(version.out, std::to_string(PLD_VERSION_MAJOR) + "." + std::to_string(PLD_VERSION_MINOR) + "." +
                             std::to_string(PLD_VERSION_PATCH) + "\n");
  const Ended rooms =
      shell("c++ -o '" + folder + "/rooms' '" PELLUCID_SOURCE_DIR "/tests/bridge/outside/rooms.cpp' $(" + config +
                "pellucid-rooms) && '" + folder + "/rooms'",
            folder);
  EXPECT_EQ(rooms.code, 0) << rooms.out;
  EXPECT_NE(rooms.out.find("composited"), std::string::npos) << rooms.out;
}

// Each component by itself: what an engine ships, what it builds with, what it reads.
TEST(BridgeInstall, ComponentsStandAlone) {
  const std::string folder = freshFolder("bridge-install-components");
  const std::pair<const char*, std::vector<const char*>> components[] = {
      {"c", {"lib/libpellucid_c.so.0"}},
      {"dev",
       {"lib/libpellucid_c.so", "include/pellucid/pellucid.h", "include/pellucid/pellucid.hpp",
        "include/pellucid/recipe.h", "lib/cmake/pellucid/pellucidConfig.cmake", "lib/cmake/pellucid/pellucid-c.cmake",
        "lib/pkgconfig/pellucid.pc"}},
      {"docs", {"share/doc/pellucid/LICENSE", "share/doc/pellucid/INTEGRATION.md"}}};
  std::uintmax_t bytes = 0;
  for (const auto& [component, files] : components) {
    const std::string prefix = folder + "/" + component;
    const Ended ended = shell(
        "cmake --install '" PELLUCID_BINARY_DIR "' --prefix '" + prefix + "' --component " + std::string(component),
        folder);
    ASSERT_EQ(ended.code, 0) << ended.out;
    for (const char* file : files)
      EXPECT_TRUE(std::filesystem::is_symlink(prefix + "/" + file) || std::filesystem::exists(prefix + "/" + file))
          << component << ": " << file;
    EXPECT_FALSE(std::filesystem::exists(prefix + "/include/pellucid-rooms")) << component;
    EXPECT_FALSE(std::filesystem::exists(prefix + "/bin")) << component;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(prefix))
      if (entry.is_regular_file() && !entry.is_symlink()) bytes += entry.file_size();
  }
  std::printf("components c, dev and docs: %.1f MB\n", static_cast<double>(bytes) / 1e6);
  if (!sanitized()) {
    EXPECT_LE(bytes, 8u << 20);
  }
}

// The C library alone asks for no package but the headers of glm and of OpenGL.
TEST(BridgeInstall, TheCLibraryConfiguresWithoutTheRoomsPackages) {
  const std::string folder = freshFolder("bridge-install-alone");
  std::string without;
  for (const char* package : {"Threads", "ZLIB", "Imath", "OpenEXR", "OpenImageIO", "TBB", "embree", "fmt", "spdlog",
                              "CLI11", "nlohmann_json", "draco", "meshoptimizer", "PkgConfig", "GTest"})
    without += std::string(" -DCMAKE_DISABLE_FIND_PACKAGE_") + package + "=ON";
  const Ended alone =
      shell("cmake -S '" PELLUCID_SOURCE_DIR "' -B '" + folder + "/build' -DPELLUCID_ROOMS=OFF" + without, folder);
  EXPECT_EQ(alone.code, 0) << alone.out;
  // What is kept away is what the rooms need.
  const Ended whole = shell("cmake -S '" PELLUCID_SOURCE_DIR "' -B '" + folder + "/whole'" + without, folder);
  EXPECT_NE(whole.code, 0);
}

}  // namespace
}  // namespace pellucid::test
