// Verbs, flags, the version and --help: what the program says of itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>

#include "composite/cli/application.h"
#include "composite/cli/help_groups.h"
#include "composite/cli/help_text.h"
#include "composite/cli/suggest.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;
using namespace cli;

TEST(Words, EditDistance) {
  EXPECT_EQ(editDistance("", ""), 0u);
  EXPECT_EQ(editDistance("", "abc"), 3u);
  EXPECT_EQ(editDistance("composite", "compsite"), 1u);
  EXPECT_EQ(editDistance("flatten", "flaten"), 1u);
  EXPECT_EQ(editDistance("study", "stduy"), 1u) << "two neighbours swapped";
  EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
}

TEST(Words, TheNearestName) {
  const std::vector<std::string> names{"--method", "--methods", "--metadata", "--normalisation", "--aa"};
  EXPECT_EQ(nearestName("--methdo", names), "--method");
  EXPECT_EQ(nearestName("--methodes", names), "--methods");
  EXPECT_EQ(nearestName("--norm", names), "--normalisation") << "its beginning";
  EXPECT_EQ(nearestName("--a", names), "--aa");
  EXPECT_EQ(nearestName("--frames", names), "");
}

// What is refused before anything is parsed; "" for what is not.
std::string refused(std::vector<const char*> words) {
  CLI::App app{"", "pellucid"};
  addVerbs(app);
  words.insert(words.begin(), "pellucid");
  try {
    checkWords(app, static_cast<int>(words.size()), words.data());
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(Words, UnknownVerbs) {
  EXPECT_NE(refused({"compsite", "a.exr"}).find("'compsite', which does not exist: did you mean composite?"),
            std::string::npos);
  EXPECT_NE(refused({"flaten"}).find("flatten"), std::string::npos);
  const std::string far = refused({"paint"});
  EXPECT_NE(far.find("'paint'"), std::string::npos) << far;
  EXPECT_NE(far.find("expected one of composite, "), std::string::npos) << far;
  EXPECT_NE(refused({}).find("no verb"), std::string::npos);
}

TEST(Words, UnknownFlags) {
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\n  lacks " << part;
  };
  has(refused({"composite", "a", "b", "-o", "c", "--methdo", "over"}),
      "--methdo, which does not exist: did you mean --method?");
  has(refused({"composite", "a", "b", "-o", "c", "--methdo=over"}), "did you mean --method?");
  has(refused({"composite", "--outptu", "c"}), "did you mean --output?");
  has(refused({"composite", "a", "-x"}), "-x");
  has(refused({"accumulate", "a", "b", "--measure"}), "--measure, which only composite takes");
  has(refused({"flatten", "a", "--no-prune"}), "only composite, accumulate and study take");
  has(refused({"--method", "over", "composite"}), "it stands after the verb");
  has(refused({"--versoin"}), "did you mean --version?");
  has(refused({"composite", "--zzzzzz"}), "pellucid composite --help lists");
}

TEST(Words, KnownOnesPass) {
  EXPECT_EQ(refused({"--version"}), "");
  EXPECT_EQ(refused({"composite", "--help"}), "");
  EXPECT_EQ(refused({"composite", "a", "b", "-o", "c", "-oc", "--aa=2", "--no-self-modulation", "--self-modulation"}),
            "");
  EXPECT_EQ(refused({"composite", "--output", "--strange", "--", "--file"}), "") << "values are not flags";
  EXPECT_EQ(refused({"study", "a", "b", "--methods", "over,sum", "--aa", "1,2"}), "");
}

TEST(Words, TheVersionIsTheProjects) {
  std::ifstream in(PELLUCID_SOURCE_DIR "/CMakeLists.txt");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::smatch version;
  ASSERT_TRUE(std::regex_search(text, version, std::regex(R"(project\(pellucid VERSION ([0-9.]+))")));
  EXPECT_EQ(runProgram({"--version"}).out, version[1].str() + "\n");
}

TEST(Words, MistypedOnesEndTheProgram) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"compsite", "a.exr", "b.glb"}, {"composite", "a.exr", "b.glb", "--methdo", "over"}}) {
    const Ended ended = runProgram(words);
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.err.find("did you mean"), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "");
  }
}

// Calls `look` with every verb and each of its flags.
template <class Look>
void eachFlag(Look look) {
  CLI::App app{"", "pellucid"};
  addVerbs(app);
  std::size_t flags = 0;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    for (const CLI::Option* option : verb->get_options()) look(*verb, *option), ++flags;
  EXPECT_GT(flags, 150u);
}

TEST(Help, EveryFlagHasAPlaceAndAText) {
  const std::vector<std::string>& groups = helpGroups();
  eachFlag([&](const CLI::App& verb, const CLI::Option& option) {
    const std::string name = verb.get_name() + " " + option.get_name();
    EXPECT_GE(option.get_description().size(), 3u) << name << " has no help text";
    if (option.get_positional()) return;
    EXPECT_TRUE(helpRow(option.get_name())) << name << " has no row in help_groups.cpp";
    EXPECT_NE(std::find(groups.begin(), groups.end(), option.get_group()), groups.end()) << name;
    const std::string text = helpSentences(option);
    EXPECT_TRUE(text.back() == '.' || text.back() == '?') << name << ": " << text;
  });
}

TEST(Help, EveryRowIsOfAFlag) {
  std::vector<std::string> known{"--version"};
  eachFlag([&](const CLI::App&, const CLI::Option& option) { known.push_back(option.get_name()); });
  const std::vector<std::string>& groups = helpGroups();
  for (const HelpRow& row : helpRows()) {
    EXPECT_NE(std::find(known.begin(), known.end(), row.flag), known.end()) << row.flag << " is a flag of no verb";
    EXPECT_NE(std::find(groups.begin(), groups.end(), row.group), groups.end()) << row.group;
  }
}

TEST(Help, LinesAreShortAndHoldAnExample) {
  CLI::App app{"", "pellucid"};
  addVerbs(app);
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::string help = verb->help();
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
    EXPECT_NE(help.find("\n  pellucid " + verb->get_name()), std::string::npos) << help;
    const std::string example = exampleOf(verb->get_name());
    ASSERT_NE(example, "") << verb->get_name();
    EXPECT_NE(help.find(example), std::string::npos);
    // The example itself holds no word that the verb lacks.
    std::istringstream words(example);
    std::vector<std::string> parts;
    for (std::string word; words >> word;) parts.push_back(word);
    std::vector<const char*> argv;
    for (std::size_t i = 1; i < parts.size(); ++i) argv.push_back(parts[i].c_str());
    EXPECT_EQ(refused(argv), "") << example;
  }
}

TEST(Help, Lists) {
  const auto has = [](const char* topic, const std::vector<std::string>& words) {
    const Ended ended = runProgram({"help", topic});
    EXPECT_EQ(ended.code, 0) << ended.err;
    for (const std::string& word : words) EXPECT_NE(ended.out.find(word), std::string::npos) << topic << " " << word;
    std::istringstream lines(ended.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  };
  has("methods", {"phenomenological", "over", "stochastic", "wavelet", "mlab"});
  has("weights", {"eq5", "eq10z", "power:K", "uniform"});
  has("precision", {"published", "float", "exact"});
  has("set", {"thin", "castsShadow", "lowResolution"});
  has("spaces", {"auto", "ACEScg", "lin_rec709", "Linear P3-D65"});
  has("presets", {"auto", "blender"});
  has("composite", {"--method", "pellucid composite"});
  EXPECT_EQ(runProgram({"help"}).out, runProgram({"--help"}).out);
  const Ended wrong = runProgram({"help", "methdos"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("did you mean methods?"), std::string::npos) << wrong.err;
}

TEST(Help, Wrapping) {
  EXPECT_EQ(wrapped("", 4, 4), "");
  EXPECT_EQ(wrapped("one two", 4, 4), "one two");
  const std::string word(40, 'x');
  EXPECT_EQ(wrapped(word + " " + word + " " + word, 4, 30), word + "\n    " + word + " " + word);
}

}  // namespace
}  // namespace pellucid
