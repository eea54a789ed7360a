// Messages promise no flag that the verb which prints them lacks.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "composite/cli/application.h"

namespace pellucid {
namespace {

using Verbs = std::set<std::string>;

// The flags of every verb, "--method" to its verbs.
std::map<std::string, Verbs> flagsOfVerbs() {
  CLI::App app{"", "pellucid"};
  cli::addVerbs(app);
  std::map<std::string, Verbs> flags;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    for (const CLI::Option* option : verb->get_options())
      for (const std::string& name : option->get_lnames()) flags["--" + name].insert(verb->get_name());
  for (const auto& [flag, verbs] : flags)
    if (flag == "--help") flags["--version"] = verbs;
  return flags;
}

// Verbs that print what a file says; a file without a row is printed by some verb that has the flag. A verb's own file
// is printed by that verb.
struct Printers {
  const char* file;  // its path, or the beginning of it
  Verbs verbs;
};
const Verbs kReaders{"composite", "accumulate", "resolve", "fragments", "study", "inspect"};  // and occlusion, which
                                                                                              // renames what it reads
const Verbs kDrawers{"composite", "accumulate", "fragments", "study"};
const Printers kPrinters[] = {
    {"gbuffer/channels.", kReaders},
    {"gbuffer/depth.", kReaders},
    {"gbuffer/opaque_read.", kReaders},
    {"gbuffer/side_files.", kReaders},
    {"gbuffer/verify_camera.", kDrawers},
    {"engine_bridge/scene/overrides.", {"composite", "accumulate", "fragments", "study", "gbuffer"}},
    {"engine_bridge/scene/gltf.", {"composite", "accumulate", "fragments", "study", "gbuffer"}},
    {"engine_bridge/scene/unseen.", kDrawers},
    {"composite/pipeline/shot.", kDrawers},
    {"composite/pipeline/colour_step.", {"composite", "accumulate", "fragments", "study", "gbuffer"}},
    {"composite/colour/config.", {"composite", "accumulate", "fragments", "study", "gbuffer"}},
    {"composite/colour/display.", {"composite", "resolve", "gbuffer", "flatten"}},
    {"composite/pipeline/resolve_planes.", {"resolve"}},
    {"composite/compare/", {"compare"}},
    {"composite/deep/flatten.", {"flatten"}},
};

Verbs printersOf(const std::string& path) {
  static const std::regex own(R"(composite/cli/(\w+)_verb\.cpp)");
  std::smatch verb;
  if (std::regex_match(path, verb, own) && verb[1] != "help") return {verb[1]};  // help tells of all verbs
  for (const Printers& row : kPrinters)
    if (path.rfind(row.file, 0) == 0) return row.verbs;
  return {};
}

struct Promise {
  std::string flag, verb;  // `verb` where the text says "accumulate --occlusion"
  int line;
};

// The flags that the string literals of a C++ text name. Comments are left out.
std::vector<Promise> promisesOf(const std::string& text, const Verbs& verbs) {
  static const std::regex literal(R"re("((?:[^"\\]|\\.)*)")re"), flag(R"((?:(\w+) )?(--[a-z][a-z-]*[a-z]))");
  std::vector<Promise> promises;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(' ') == line.find("//")) continue;
    for (std::sregex_iterator at(line.begin(), line.end(), literal), end; at != end; ++at) {
      const std::string words = (*at)[1];
      for (std::sregex_iterator named(words.begin(), words.end(), flag); named != end; ++named) {
        const std::string before = (*named)[1];
        promises.push_back({(*named)[2], verbs.count(before) ? before : "", number});
      }
    }
  }
  return promises;
}

// One sentence for every flag of `text` that no verb has, or that one of those that print it lacks.
std::vector<std::string> broken(const std::string& path, const std::string& text) {
  static const std::map<std::string, Verbs> flags = flagsOfVerbs();
  Verbs verbs;
  for (const auto& [flag, having] : flags) verbs.insert(having.begin(), having.end());
  std::vector<std::string> found;
  for (const Promise& promise : promisesOf(text, verbs)) {
    const auto having = flags.find(promise.flag);
    const std::string at = path + ":" + std::to_string(promise.line) + ": names " + promise.flag;
    if (having == flags.end()) {
      found.push_back(at + ", which no verb has");
      continue;
    }
    for (const std::string& verb : promise.verb.empty() ? printersOf(path) : Verbs{promise.verb})
      if (!having->second.count(verb)) found.push_back(at + ", which " + verb + " lacks");
  }
  return found;
}

TEST(Messages, NameFlagsThatTheirVerbsHave) {
  std::size_t files = 0, promises = 0;
  std::string told;
  for (const char* room : {"composite", "gbuffer", "engine_bridge"})
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(PELLUCID_SOURCE_DIR "/" + std::string(room))) {
      const std::string extension = entry.path().extension().string();
      if (!entry.is_regular_file() || (extension != ".cpp" && extension != ".h")) continue;
      std::ifstream in(entry.path());
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      const std::string path = entry.path().lexically_relative(PELLUCID_SOURCE_DIR).string();
      for (const std::string& sentence : broken(path, text)) told += sentence + "\n";
      promises += promisesOf(text, {}).size();
      ++files;
    }
  EXPECT_EQ(told, "");
  EXPECT_GT(files, 200u);
  EXPECT_GT(promises, 150u);
  std::printf("%zu files name flags %zu times\n", files, promises);
}

TEST(Messages, PlantedPromisesAreFound) {
  EXPECT_EQ(broken("composite/cli/resolve_verb.cpp", R"(throw Error("a: expected --layers D");)").size(), 0u);
  EXPECT_EQ(broken("composite/cli/resolve_verb.cpp", R"(throw Error("a: expected one, or --camera NAME");)").size(),
            1u);
  EXPECT_EQ(broken("composite/cli/resolve_verb.cpp", R"(f("those of accumulate --camera");)").size(), 0u);
  EXPECT_EQ(broken("gbuffer/channels.cpp", R"(f("or --environment R,G,B");)").size(), 2u)
      << "resolve and inspect lack it";
  EXPECT_EQ(broken("engine_bridge/gl/any.cpp", R"(f("--no-such-flag", "--shadow-size");)").size(), 1u);
  EXPECT_EQ(broken("engine_bridge/gl/any.cpp", R"(  // "--no-such-flag")").size(), 0u);
}

TEST(Messages, FlagsAreNamedOnce) {
  const Ended method = runProgram({"accumulate", "--method", "moments:4", "a.exr", "b.glb", "-o", "c.exr"});
  EXPECT_EQ(method.code, 2) << method.err;
  EXPECT_NE(method.err.find("error: --method: found 'moments:4'"), std::string::npos) << method.err;
  const Ended folder = runProgram({"study", "a.exr", "b.glb", "-o", ""});
  EXPECT_EQ(folder.code, 2) << folder.err;
  EXPECT_NE(folder.err.find("found an empty name, expected that of a folder"), std::string::npos) << folder.err;
}

}  // namespace
}  // namespace pellucid
