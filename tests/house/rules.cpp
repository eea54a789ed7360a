#include "tests/house/rules.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <regex>
#include <set>

namespace pellucid::test {
namespace {

using Names = std::set<std::string>;

// What a room's files may include. A room that is not listed here may be included by nobody and include nothing.
const std::map<std::string, Names> kArrows = {
    {"shaders", {"shaders"}},
    {"gbuffer", {"gbuffer", "shaders"}},
    {"engine_bridge", {"engine_bridge", "gbuffer", "shaders"}},
    {"composite", {"composite", "gbuffer", "shaders"}},
    {"composite/pipeline", {"composite/pipeline", "composite", "engine_bridge", "gbuffer", "shaders"}},
    {"composite/cli", {"composite/cli", "composite/pipeline", "composite", "engine_bridge", "gbuffer", "shaders"}},
    {"python", {"python", "composite/cli", "composite/pipeline", "composite", "engine_bridge", "gbuffer", "shaders"}},
    {"samples", {"samples", "composite/cli", "composite/pipeline", "composite", "engine_bridge", "gbuffer", "shaders"}},
    // Benchmarks measure what tests build: they share tests/support.
    {"bench",
     {"bench", "tests", "samples", "composite/cli", "composite/pipeline", "composite", "engine_bridge", "gbuffer",
      "shaders"}},
    {"tests",
     {"tests", "samples", "composite/cli", "composite/pipeline", "composite", "engine_bridge", "gbuffer", "shaders"}},
};

struct Library {
  const char* prefix;  // of the include
  Names homes;         // folders that may include it, besides tests
};
const Library kLibraries[] = {{"epoxy/", {"engine_bridge/gl", "samples/engine", "samples/stained"}},
                              {"EGL/", {"engine_bridge/gl", "samples/osg"}},
                              {"GL/", {"engine_bridge/gl", "engine_bridge/c", "samples/vtk"}},
                              {"vulkan/", {"samples/vulkan"}},
                              {"glslang/", {"samples/vulkan"}},
                              {"embree3/", {"engine_bridge/embree"}},
                              {"openvdb/", {"engine_bridge/scene/parts"}},
                              {"OpenImageIO/", {"gbuffer/parts", "composite/study/parts", "samples"}},
                              {"OpenColorIO/", {"composite/colour"}},
                              {"pybind11/", {"python"}},
                              {"OpenEXR/", {"gbuffer", "samples/generate"}}};

bool isBelow(const std::string& path, const std::string& folder) {
  return path.rfind(folder + "/", 0) == 0;
}

std::string at(const SourceFile& file, int line) {
  return file.path + ":" + std::to_string(line) + ": ";
}

// GLSL includes count from shaders/, a file of the same folder may be named alone.
std::string resolved(const SourceFile& file, const std::string& include) {
  if (isBelow(file.path, "shaders") && (isBelow(include, "shared") || isBelow(include, "gl")))
    return "shaders/" + include;
  if (include.find('/') == std::string::npos) return file.path.substr(0, file.path.rfind('/') + 1) + include;
  return std::filesystem::path(include).lexically_normal().string();
}

struct Pattern {
  std::regex found;
  const char* what;
};

// Where rounding is the matter itself.
constexpr std::string_view kExactSums = "shaders/shared/exact_sums.glsl";
constexpr const char* kInDoubles = "double precision; expected float only";

const std::vector<Pattern>& sharedPatterns() {
  static const std::vector<Pattern> patterns = {
      {std::regex(R"((^|[^A-Za-z0-9_.])(\d+\.\d*|\.\d+|\d+(?=[eE]))([eE][-+]?\d+)?(?![0-9.eEfFuU]))"),
       "a double literal; expected the suffix f"},
      {std::regex(R"([A-Za-z0-9_)\]]\s*\.\s*([xyzw]{2,4}|[rgba]{2,4}|[stpq]{2,4})\b)"),
       "a multi-letter swizzle, which GLM has none of here"},
      {std::regex(
           R"(\b(sample|input|output|filter|common|active|half|buffer|shared|flat|patch|and|or|not|new|near|far)\b)"),
       "a word that GLSL, C++ or Windows keeps for itself"},
      {std::regex(R"(\b(double|dvec[234]|dmat[234])\b)"), kInDoubles},
      {std::regex(R"(\b(inout|out)\b)"), "a parameter by reference; expected results in a struct"},
      {std::regex(R"(\b(gl_\w+|texture\w*|texelFetch\w*|dFd[xy]\w*|fwidth\w*|discard|uniform)\b)"),
       "sampling, derivatives or GL state; expected in shaders/gl/"},
  };
  return patterns;
}

bool isAllowedDirective(const std::string& line) {
  static const std::regex allowed(R"re(^#pragma once\s*$|^#include "shared/\w+\.glsl"\s*$)re");
  return std::regex_search(line, allowed);
}

}  // namespace

const std::vector<std::string>& rooms() {
  static const std::vector<std::string> names = {"shaders", "gbuffer", "engine_bridge", "composite",
                                                 "python",  "samples", "bench",         "tests"};
  return names;
}

std::string roomOf(const std::string& path) {
  for (const char* room : {"composite/cli", "composite/pipeline"})
    if (isBelow(path, room)) return room;
  return path.substr(0, path.find('/'));
}

Violations againstArrows(const SourceFile& file) {
  Violations found;
  const std::string from = roomOf(file.path);
  const auto arrows = kArrows.find(from);
  if (arrows == kArrows.end()) return {file.path + ": lies in no room that the arrows know"};
  for (const Include& include : includesOf(file.text)) {
    const std::string path = resolved(file, include.name), to = roomOf(path);
    // In angle brackets only what names one of our rooms is ours.
    if (!include.quoted && (path.find('/') == std::string::npos || !kArrows.count(to) ||
                            !std::filesystem::exists(std::string(PELLUCID_SOURCE_DIR "/") + path)))
      continue;
    if (!kArrows.count(to))
      found.push_back(at(file, include.line) + "includes \"" + include.name +
                      "\", which is in no room; expected a path from the top");
    else if (!arrows->second.count(to))
      found.push_back(at(file, include.line) + from + " includes " + include.name + " of " + to);
  }
  return found;
}

Violations libraryOutsideItsRoom(const SourceFile& file) {
  Violations found;
  if (roomOf(file.path) == "tests") return found;
  for (const Include& include : includesOf(file.text))
    for (const Library& library : kLibraries) {
      const bool home = std::any_of(library.homes.begin(), library.homes.end(),
                                    [&](const std::string& folder) { return isBelow(file.path, folder); });
      if (include.name.rfind(library.prefix, 0) == 0 && !home)
        found.push_back(at(file, include.line) + "includes " + include.name + "; expected only in " +
                        *library.homes.begin());
    }
  return found;
}

Violations againstSharedText(const SourceFile& file) {
  Violations found;
  const std::vector<std::string> raw = linesOf(file.text), code = linesOf(withoutComments(file.text));
  for (std::size_t i = 0; i < code.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    if (code[i].find('#') != std::string::npos) {
      if (!isAllowedDirective(raw[i]))
        found.push_back(at(file, number) + "a directive other than #pragma once and #include \"shared/...\"");
      continue;
    }
    for (const Pattern& pattern : sharedPatterns())
      if (std::smatch match;
          std::regex_search(code[i], match, pattern.found) && !(pattern.what == kInDoubles && file.path == kExactSums))
        found.push_back(at(file, number) + "'" + match.str() + "': " + pattern.what);
  }
  return found;
}

Violations definedTwice(const std::vector<SourceFile>& files) {
  static const std::regex opens(R"(^namespace ([\w:]*) ?\{)"), closes(R"(^\}  // namespace)"),
      defines(R"(^(?:struct|class|enum class|union) (\w+)(?: final)?(?: : [^{]*)? ?\{)");
  Violations violations;
  std::map<std::string, std::string> firsts;
  for (const SourceFile& file : files) {
    if (!file.path.ends_with(".h")) continue;
    std::vector<std::string> spaces;
    int number = 0;
    for (const std::string& line : linesOf(file.text)) {
      ++number;
      std::smatch match;
      if (std::regex_search(line, match, opens)) {
        spaces.push_back(match[1].length() ? match[1].str() : "of " + file.path);
      } else if (std::regex_search(line, closes) && !spaces.empty()) {
        spaces.pop_back();
      } else if (std::regex_search(line, match, defines)) {
        std::string name;
        for (const std::string& space : spaces) name += space + "::";
        const auto [first, added] = firsts.emplace(name + match[1].str(), at(file, number));
        if (!added) violations.push_back(first->second + first->first + " is defined in " + at(file, number) + "too");
      }
    }
  }
  return violations;
}

namespace {

// A part's name: the path without its ending.
std::string partOf(const std::string& path) {
  return path.substr(0, path.rfind('.'));
}

// Which parts each part needs.
std::map<std::string, Names> needsIn(const std::string& folder, const std::vector<SourceFile>& files) {
  static const std::regex type(R"(^ *(?:struct|class) (\w+)(?: final)?(?: : [^{;]*)? ?\{)"),
      member(R"(^[\w:<>,&*~ ]*?\b(\w+)::~?\w+\()");
  std::map<std::string, Names> needs;
  std::map<std::string, std::string> homes;  // of types, by the header that defines them
  for (const SourceFile& file : files) {
    if (!isBelow(file.path, folder)) continue;
    Names& part = needs[partOf(file.path)];
    for (const Include& include : includesOf(file.text))
      if (const std::string path = resolved(file, include.name); isBelow(path, folder)) part.insert(partOf(path));
    part.erase(partOf(file.path));
    for (const std::string& line : linesOf(file.text))
      if (std::smatch match; file.path.ends_with(".h") && std::regex_search(line, match, type))
        homes[match[1]] = partOf(file.path);
  }
  for (const SourceFile& file : files) {
    if (!isBelow(file.path, folder) || file.path.ends_with(".h")) continue;
    for (const std::string& line : linesOf(withoutComments(file.text)))
      if (std::smatch match; std::regex_search(line, match, member))
        if (const auto home = homes.find(match[1]); home != homes.end() && home->second != partOf(file.path))
          needs[home->second].insert(partOf(file.path));
  }
  return needs;
}

}  // namespace

Violations circlesIn(const std::string& folder, const std::vector<SourceFile>& files) {
  const std::map<std::string, Names> needs = needsIn(folder, files);
  Violations found;
  Names done;
  std::vector<std::string> way;
  const std::function<void(const std::string&)> follow = [&](const std::string& part) {
    if (const auto first = std::find(way.begin(), way.end(), part); first != way.end()) {
      std::string circle;
      for (auto step = first; step != way.end(); ++step) circle += *step + " needs ";
      found.push_back(circle + part);
      return;
    }
    if (!done.insert(part).second) return;
    way.push_back(part);
    if (const auto next = needs.find(part); next != needs.end())
      for (const std::string& one : next->second) follow(one);
    way.pop_back();
  };
  for (const auto& [part, others] : needs) follow(part);
  return found;
}

Violations headersNamedTwice(const std::vector<SourceFile>& files) {
  std::map<std::string, std::string> first;
  Violations found;
  for (const SourceFile& file : files) {
    if (!file.path.ends_with(".h")) continue;
    const auto [other, isNew] = first.emplace(file.path.substr(file.path.rfind('/') + 1), file.path);
    if (!isNew) found.push_back(file.path + ": has the name of " + other->second);
  }
  return found;
}

Violations roomsWithoutReadme(const std::string& top) {
  Violations found;
  const auto isEmpty = [](const std::filesystem::path& folder) {
    const std::filesystem::recursive_directory_iterator files(folder);
    return std::none_of(begin(files), end(files), [](const auto& entry) { return entry.is_regular_file(); });
  };
  const auto need = [&](const std::filesystem::path& folder) {
    if (isEmpty(folder)) return;
    std::error_code failure;
    const auto size = std::filesystem::file_size(folder / "README.md", failure);
    if (failure || size == 0) found.push_back((folder / "README.md").string() + ": missing or empty");
  };
  need(top);
  for (const std::string& room : rooms())
    if (std::filesystem::is_directory(std::filesystem::path(top) / room)) need(std::filesystem::path(top) / room);
  const std::filesystem::path samples = std::filesystem::path(top) / "samples";
  if (std::filesystem::is_directory(samples))
    for (const auto& entry : std::filesystem::directory_iterator(samples))
      if (entry.is_directory() && entry.path().filename() != "generate") need(entry.path());
  return found;
}

}  // namespace pellucid::test
