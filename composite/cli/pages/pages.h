// What is installed beside the program and says what its flags are, made of the flags themselves: pages for man, and
// completion for two shells.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace pellucid::cli {

std::string manOfProgram(const CLI::App& app, const std::string& version);
std::string manOfVerb(const CLI::App& verb, const CLI::App& app, const std::string& version);
std::string bashCompletion(const CLI::App& app);
std::string zshCompletion(const CLI::App& app);
// All of it as one JSON object, for skins in other languages: version, exits, methods, and verbs with their flags.
std::string flagTable(const CLI::App& app, const std::string& version);

// What an exit code means. 130 and 143 share a row.
struct ExitRow {
  const char *codes, *meaning;
};
const std::vector<ExitRow>& exitRows();

// What may stand after a flag, for completion.
struct ValueWords {
  bool none = false;                 // a switch
  std::vector<std::string> choices;  // one of these
  std::string ending;                // a file whose name ends so, "exr"; or any file, ""
  bool file = false, folder = false;
};
ValueWords valueWords(const CLI::Option& option, const std::string& verb);
std::vector<const CLI::App*> verbsOf(const CLI::App& app);

}  // namespace pellucid::cli
