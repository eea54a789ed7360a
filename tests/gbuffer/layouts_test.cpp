// Files as renderers write them, given to the program without a flag: the picture is right, or one sentence says what
// to give. The table of gbuffer/README.md is what is measured here.
#include "layouts.h"

#include <gtest/gtest.h>

#include "gbuffer/exr_document.h"
#include "room_glass.h"

namespace pellucid::test {
namespace {

struct Outcome {
  std::string said;       // one cell of the table
  std::size_t wrong = 0;  // pixels
};

std::string depthLineOf(const std::string& err) {
  const std::size_t from = err.find("pellucid: depth: ");
  return from == std::string::npos ? "" : err.substr(from, err.find('\n', from) - from);
}

// Pixels that do not show the near sheet over the room, and nothing of the far one.
std::size_t wrongPixels(const std::string& path, const std::string& red) {
  const ExrDocument out = readExr(path);
  const std::string end = red.substr(red.rfind('.') + 1), layer = red.substr(0, red.size() - end.size());
  const bool words = end == "red";
  const std::string names[] = {red, layer + (words ? "green" : "G"), layer + (words ? "blue" : "B")};
  const float right[] = {kBehind / 2, kBehind / 2 + 0.5f, kBehind / 2};
  for (const ExrPart& part : out.parts) {
    if (!part.find(red)) continue;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < std::size_t{Room::kWidth} * Room::kHeight; ++i) {
      bool off = false;
      for (int c = 0; c < 3; ++c) off = off || !(std::abs(part.find(names[c])->at(i) - right[c]) <= 1e-3f);
      wrong += off;
    }
    return wrong;
  }
  return std::size_t{Room::kWidth} * Room::kHeight;
}

Outcome droppedIn(const Layout& layout, const std::string& folder) {
  RunOptions options;
  options.folder = folder;
  writeFile(folder + "/shot.exr", layout.parts);
  const Ended ended = runProgram({"composite", "shot.exr", "glass.glb", "-o", "out.exr"}, options);
  if (ended.code != 0) {
    EXPECT_EQ(ended.code, 4) << ended.err;
    const bool names = ended.err.find("--depth") != std::string::npos;
    EXPECT_TRUE(names) << ended.err;
    return {ended.err.find("--depth-kind") != std::string::npos ? "asks for `--depth-kind`" : "asks for `--depth`", 0};
  }
  const std::string line = depthLineOf(ended.err), taken = "depth: " + layout.depth + ", ";
  EXPECT_NE(line.find(taken), std::string::npos) << line;
  EXPECT_NE(ended.err.find(std::string("preset ") + layout.producer), std::string::npos) << ended.err;
  const std::size_t from = line.find('('), to = line.find(')', from);
  std::string said = from == std::string::npos ? "" : line.substr(from + 1, to - from - 1);
  EXPECT_EQ(said, layout.decided);
  if (ended.err.find("fit no other reading") != std::string::npos) said += ", by the planes of the picture";
  if (ended.err.find("is negative") != std::string::npos) said += ", as its numbers are below 0";
  return {said, wrongPixels(folder + "/out.exr", layout.beauty)};
}

TEST(Layouts, DroppedInWithoutAFlagAreRightOrAskedAbout) {
  const std::string folder = freshFolder("gbuffer-layouts");
  const Room room;
  writeRoomGlass(folder + "/glass.glb", room);
  std::string table = "| preset | depth | said | pixels wrong |\n| --- | --- | --- | --- |\n";
  std::size_t wrong = 0;
  for (const Layout& layout : layoutsOf(room)) {
    SCOPED_TRACE(std::string(layout.producer) + ", " + layout.depth + ", " + layout.words);
    const Outcome outcome = droppedIn(layout, folder);
    EXPECT_EQ(outcome.wrong, 0u);
    EXPECT_EQ(outcome.said.starts_with("asks"), layout.decided.empty()) << outcome.said;
    wrong += outcome.wrong;
    table += "| " + std::string(layout.producer) + " | `" + layout.depth + "`, " + layout.words + " | " + outcome.said +
             " | " + std::to_string(outcome.wrong) + " |\n";
  }
  std::printf("%s", table.c_str());
  EXPECT_EQ(wrong, 0u);
  EXPECT_NE(slurp(PELLUCID_SOURCE_DIR "/gbuffer/README.md").find("\n" + table + "\n"), std::string::npos)
      << "gbuffer/README.md has another table than the one above";
}

}  // namespace
}  // namespace pellucid::test
