// Man pages and completion: every flag is in them, and the tools that read them take them.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "composite/cli/application.h"
#include "composite/cli/pages/pages.h"
#include "composite/cli/suggest.h"
#include "composite/methods/method.h"
#include "tests/support/program.h"
#include "tests/support/shell.h"

namespace pellucid {
namespace {

using namespace test;
using namespace cli;

class Pages : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("pages-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    RunOptions options;
    options.program = "pellucid_pages";
    ASSERT_EQ(runProgram({folder}, options).code, 0);
    addVerbs(app);
  }
  // What a shell says that stands in the folder of the pages.
  Ended inFolder(const std::string& command) { return shell("cd '" + folder + "' && " + command, folder); }
  bool has(const std::string& tool) { return inFolder("command -v " + tool).code == 0; }
  std::string folder;
  CLI::App app{"", "pellucid"};
};

std::string without(std::string text, char gone) {
  std::erase(text, gone);
  return text;
}

TEST_F(Pages, ManHasEveryFlagOfEveryVerb) {
  std::size_t flags = 0;
  for (const CLI::App* verb : verbsOf(app)) {
    const std::string page = without(slurp(folder + "/man/man1/pellucid-" + verb->get_name() + ".1"), '\\');
    for (const std::string& flag : flagsOf(*verb)) {
      EXPECT_NE(page.find(flag), std::string::npos) << verb->get_name() << " " << flag;
      ++flags;
    }
    EXPECT_NE(page.find(".SH EXIT STATUS"), std::string::npos);
    EXPECT_NE(slurp(folder + "/man/man1/pellucid.1").find(".B " + verb->get_name()), std::string::npos);
  }
  EXPECT_GT(flags, 200u);
}

TEST_F(Pages, ManReadsThemWithoutAWarning) {
  if (!has("man")) GTEST_SKIP() << "man is not installed";
  const Ended ended =
      inFolder("for page in man/man1/*; do man --warnings -E UTF-8 -l \"$page\" >/dev/null || exit 1; done");
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.out, "");
}

TEST_F(Pages, BashCompletes) {
  if (!has("bash")) GTEST_SKIP() << "bash is not installed";
  std::ofstream(folder + "/shot.exr") << "";
  std::ofstream(folder + "/shot.txt") << "";
  const auto completed = [&](const std::string& words, int at) {
    return inFolder("bash -c 'source bash-completion/completions/pellucid; COMP_WORDS=(" + words +
                    "); COMP_CWORD=" + std::to_string(at) + "; _pellucid; echo \"${COMPREPLY[@]}\"'")
        .out;
  };
  EXPECT_EQ(completed("pellucid comp", 1), "composite compare\n");
  EXPECT_EQ(completed("pellucid composite --meth", 2), "--method --method-from\n");
  EXPECT_EQ(completed("pellucid composite --shadows exa", 3), "exact exact:opaque\n");
  EXPECT_EQ(completed("pellucid accumulate --measu", 2), "\n") << "a flag of another verb";
  EXPECT_EQ(completed("pellucid composite --shadow-views sho", 3), "shot.exr\n");
}

TEST_F(Pages, ZshReadsIt) {
  if (!has("zsh")) GTEST_SKIP() << "zsh is not installed";
  const Ended ended = inFolder("zsh -n zsh/vendor-completions/_pellucid");
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.out, "");
  const std::string text = slurp(folder + "/zsh/vendor-completions/_pellucid");
  for (const CLI::App* verb : verbsOf(app))
    for (const std::string& flag : flagsOf(*verb))
      EXPECT_NE(text.find("'*" + flag + "["), std::string::npos) << verb->get_name() << " " << flag;
}

// What add-ons in other languages read in the place of --help.
TEST_F(Pages, TheTableHasEveryFlagWithItsHelp) {
  const nlohmann::json table = nlohmann::json::parse(slurp(folder + "/pellucid/flags.json"));
  for (const CLI::App* verb : verbsOf(app)) {
    std::set<std::string> names;
    for (const nlohmann::json& row : table["verbs"][verb->get_name()]) {
      for (const nlohmann::json& name : row["names"]) names.insert("--" + name.get<std::string>());
      EXPECT_NE(row["help"], "") << row;
    }
    for (const std::string& flag : flagsOf(*verb))
      EXPECT_TRUE(flag.rfind("--", 0) != 0 || names.count(flag)) << verb->get_name() << " " << flag;
  }
  const nlohmann::json& flags = table["verbs"]["composite"];
  const auto precision =
      std::find_if(flags.begin(), flags.end(), [](const nlohmann::json& row) { return row["flag"] == "--precision"; });
  ASSERT_NE(precision, flags.end());
  EXPECT_EQ((*precision)["choices"], (nlohmann::json{"published", "float", "exact"}));
  EXPECT_EQ((*precision)["default"], "float");
  EXPECT_EQ(table["exits"]["6"], "Disk, memory or the GL device ran out.");
  EXPECT_EQ(table["methods"][0]["name"], allMethods()[0].name);
}

}  // namespace
}  // namespace pellucid
