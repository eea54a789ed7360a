// The tree as it stands keeps the rules.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/house/rules.h"

namespace pellucid::test {
namespace {

std::string told(const Violations& violations) {
  std::string out;
  for (const std::string& sentence : violations) out += sentence + "\n";
  return out;
}

template <class Rule>
Violations overTree(const std::string& folder, Rule rule) {
  Violations all;
  for (const SourceFile& file : sourceFiles()) {
    if (file.path.rfind(folder, 0) != 0) continue;
    const Violations found = rule(file);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

TEST(House, TheSearchSeesTheTree) {
  const std::vector<SourceFile> files = sourceFiles();
  std::size_t includes = 0;
  for (const SourceFile& file : files) includes += includesOf(file.text).size();
  std::printf("%zu files, %zu includes\n", files.size(), includes);
  for (const char* known :
       {"shaders/shared/resolve.glsl", "gbuffer/image.h", "composite/cli/main.cpp", "tests/house/tree_test.cpp"})
    EXPECT_TRUE(std::any_of(files.begin(), files.end(), [&](const SourceFile& file) { return file.path == known; }))
        << known;
  EXPECT_GT(includes, files.size());
}

TEST(House, IncludesFollowTheArrows) {
  const Violations found = overTree("", againstArrows);
  EXPECT_TRUE(found.empty()) << told(found);
}

TEST(House, LibrariesStayInTheirRoom) {
  const Violations found = overTree("", libraryOutsideItsRoom);
  EXPECT_TRUE(found.empty()) << told(found);
}

TEST(House, SharedTextSuitsBothCompilers) {
  const Violations found = overTree("shaders/shared/", againstSharedText);
  EXPECT_TRUE(found.empty()) << told(found);
}

TEST(House, NamesOfTypesAreTheirOwn) {
  const Violations found = definedTwice(sourceFiles());
  EXPECT_TRUE(found.empty()) << told(found);
}

TEST(House, NamesOfHeadersAreTheirOwn) {
  const Violations found = headersNamedTwice(sourceFiles());
  EXPECT_TRUE(found.empty()) << told(found);
}

TEST(House, TheCLibraryHasNoCircles) {
  const Violations found = circlesIn("engine_bridge/c", sourceFiles());
  EXPECT_TRUE(found.empty()) << told(found);
}

TEST(House, EveryRoomHasAReadme) {
  const Violations found = roomsWithoutReadme(PELLUCID_SOURCE_DIR);
  EXPECT_TRUE(found.empty()) << told(found);
}

}  // namespace
}  // namespace pellucid::test
