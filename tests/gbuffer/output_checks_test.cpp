// Outputs are refused by their names and folders alone.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "gbuffer/errors.h"
#include "gbuffer/output_checks.h"
#include "tests/gbuffer/exr_files.h"

namespace pellucid {
namespace {

using namespace test;

// Exit code and sentence, or 0.
std::pair<int, std::string> refused(const std::vector<Output>& outputs, const std::vector<std::string>& inputs = {}) {
  try {
    checkOutputs(outputs, inputs);
  } catch (const Error& error) {
    return {error.exitCode(), error.what()};
  }
  return {0, ""};
}

void expectRefused(int code, const std::string& word, const std::vector<Output>& outputs,
                   const std::vector<std::string>& inputs = {}) {
  const auto [found, sentence] = refused(outputs, inputs);
  EXPECT_EQ(found, code) << sentence;
  EXPECT_NE(sentence.find(word), std::string::npos) << sentence;
}

TEST(OutputChecks, NamesSayWhatIsWritten) {
  TemporaryFolder folder;
  for (const char* good : {"a.exr", "A.EXR", "a.b.exr", "has space.exr"})
    EXPECT_EQ(refused({{"-o", folder.path(good)}}).first, 0) << good;
  for (const char* bad : {"a.png", "a.jpg", "a", "exr", ".exr", "a.exr.tif", "a.exrx", ""})
    expectRefused(2, bad, {{"-o", *bad ? folder.path(bad) : ""}});
  EXPECT_EQ(refused({{"--html", folder.path("a.html"), OutputKind::page}}).first, 0);
  expectRefused(2, "--html", {{"--html", folder.path("a.exr"), OutputKind::page}});
  EXPECT_EQ(refused({{"-o", folder.path("report"), OutputKind::folder}}).first, 0);
  EXPECT_EQ(refused({{"-o", folder.path("a/b/c"), OutputKind::folder}}).first, 0) << "made with those above it";
  expectRefused(2, "folder", {{"-o", folder.path("report.exr"), OutputKind::folder}});
}

TEST(OutputChecks, FoldersMustBeThere) {
  TemporaryFolder folder;
  spit(folder.path("file"), "x");
  std::filesystem::create_directory(folder.path("folder.exr"));
  expectRefused(6, folder.path("none"), {{"-o", folder.path("none/a.exr")}});
  expectRefused(6, folder.path("file"), {{"-o", folder.path("file/a.exr")}});
  expectRefused(6, "found a folder", {{"-o", folder.path("folder.exr")}});
  expectRefused(6, "found a file", {{"-o", folder.path("file"), OutputKind::folder}});
  expectRefused(6, "found a file", {{"-o", folder.path("file/below"), OutputKind::folder}});
  EXPECT_EQ(folder.list(), (std::vector<std::string>{"file", "folder.exr"})) << "nothing was written";
  if (::geteuid() == 0) return;  // root writes everywhere
  ::chmod(folder.path("folder.exr").c_str(), 0555);
  expectRefused(6, folder.path("folder.exr"), {{"-o", folder.path("folder.exr/a.exr")}});
  expectRefused(6, folder.path("folder.exr"), {{"-o", folder.path("folder.exr/report"), OutputKind::folder}});
}

TEST(OutputChecks, InputsAreKept) {
  TemporaryFolder folder;
  spit(folder.path("in.exr"), "x");
  std::filesystem::create_symlink("in.exr", folder.path("link.exr"));
  std::filesystem::create_hard_link(folder.path("in.exr"), folder.path("hard.exr"));
  for (const char* name : {"in.exr", "link.exr", "hard.exr"})
    expectRefused(2, "input", {{"-o", folder.path(name)}}, {folder.path("in.exr")});
  expectRefused(2, "input", {{"-o", folder.path("./in.exr")}}, {"elsewhere.glb", folder.path("in.exr")});
  EXPECT_EQ(refused({{"-o", folder.path("out.exr")}}, {folder.path("in.exr")}).first, 0);
  expectRefused(2, "--shadow-views", {{"-o", folder.path("new.exr")}, {"--shadow-views", folder.path("./new.exr")}});
}

}  // namespace
}  // namespace pellucid
