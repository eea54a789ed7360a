#include "engine_bridge/c/glsl_text.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <regex>
#include <set>
#include <sstream>

#include "shaders/shader_source.h"

namespace pellucid::c {
namespace {

bool isWord(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// Every word of `text`, as `changed` wants it. Comments go: a compiler has no use for them, and a log shows the lines.
template <class F>
std::string withWords(const std::string& text, F changed) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    if (text.compare(i, 2, "//") == 0) {
      i = std::min(text.find('\n', i), text.size());
      while (!out.empty() && out.back() == ' ') out.pop_back();
    } else if (isWord(text[i])) {
      std::size_t end = i;
      while (end < text.size() && isWord(text[end])) ++end;
      out += changed(text.substr(i, end - i));
      i = end;
    } else {
      out += text[i++];
    }
  }
  return out;
}

// What a text declares outside of functions: functions, structs, outputs, constants, variables, macros, and macros that
// it looks for. Outputs may stand in a macro, several of them in one line.
std::set<std::string> declaredIn(const std::string& text) {
  static const std::regex patterns[] = {std::regex(R"(^(?:PLD_FN )?[A-Za-z]\w* (\w+)\()"),
                                        std::regex(R"(^struct (\w+))"), std::regex(R"(^const \w+ (\w+) =)"),
                                        std::regex(R"(^(?:bool|float|vec\d) (\w+)(?: =|;))"),
                                        std::regex(R"(^ *#(?:define|ifdef|ifndef) ((?!GL_)\w+))")};
  static const std::regex several[] = {std::regex(R"(layout\(location = \d\) out \w+ (\w+);)"),
                                       std::regex(R"(defined\(((?!GL_)\w+)\))")};
  std::set<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    for (const std::regex& pattern : patterns)
      if (std::smatch match; std::regex_search(line, match, pattern)) names.insert(match[1]);
    for (const std::regex& pattern : several)
      for (std::sregex_iterator match(line.begin(), line.end(), pattern), end; match != end; ++match)
        names.insert((*match)[1]);
  }
  return names;
}

std::string storageLayout(int binding) {
  return "layout(std430, binding = " + std::to_string(binding) + ")";
}

std::string withoutPreciseBelow400(const std::string& word, int version) {
  return version < 400 && word == "precise" ? std::string() : word;
}

bool isPublic(const std::string& word) {
  for (const char* one : {"pldWriteCaster", "pldCasterIdentity", "pldShadow", "pldShadowOnOpaque"})
    if (word == one) return true;
  return false;
}

// How the names of one text keep clear of the host's and of each other's.
struct Names {
  const char* guard;
  const char* prefix;     // of what the host does not call
  const char* constants;  // of constants, in place of PLD_; empty leaves them
};

std::string hostText(const std::string& file, const std::vector<std::string>& defines, int version,
                     const SeamPlaces& at, const Names& names) {
  std::string text = shaderSource(file, defines);
  text.erase(0, text.find('\n') + 1);  // #version
  text.erase(0, std::string("#define PLD_FN\n").size());
  const std::set<std::string> own = declaredIn(text);
  const bool places = version >= 420;
  const auto unit = [&](int i) {
    return places ? "layout(binding = " + std::to_string(at.firstUnit + i) + ")" : std::string();
  };
  text = withWords(text, [&](const std::string& word) -> std::string {
    if (word == "PLD_FN") return {};
    if (word == "PLD_FRAME_LAYOUT")
      return places ? "layout(std140, binding = " + std::to_string(at.uniformBinding) + ")" : "layout(std140)";
    if (word.rfind("PLD_STORAGE_", 0) == 0) return storageLayout(at.firstStorage + word.back() - '0');
    if (word == "PLD_UNIT_0") return unit(0);
    if (word == "PLD_UNIT_1") return unit(1);
    if (word == "PLD_UNIT_2") return unit(2);
    if (word == "PLD_UNIT_3") return unit(3);
    if (own.count(word) && word.rfind("PLD_", 0) == 0)
      return names.constants[0] ? names.constants + word.substr(4) : word;
    // Of the shared text pldExp() and its like are not the host's to call, but theirs is the name in the layers' seam.
    const bool hosts =
        word.rfind("Pld", 0) == 0 || (word.rfind("pld", 0) == 0 && (!names.constants[0] || isPublic(word)));
    if (own.count(word) && !hosts) return names.prefix + word;
    return withoutPreciseBelow400(word, version);
  });
  return std::string("#ifndef ") + names.guard + "\n#define " + names.guard + "\n" + text + "#endif\n";
}

}  // namespace

OwnText ownText(const std::string& file, const std::vector<std::string>& defines, int version) {
  static const std::regex bound(R"(layout\(binding = (\d+)\) (uniform sampler2D (\w+);))");
  OwnText own;
  std::string text = shaderSource(file, defines);
  text.erase(0, text.find('\n') + 1);  // #version
  for (std::sregex_iterator match(text.begin(), text.end(), bound), end; match != end; ++match)
    own.samplers.push_back({(*match)[3], std::stoi((*match)[1])});
  text = std::regex_replace(text, bound, "$2");
  own.text = "#version " + std::to_string(version) + " core\n" +
             withWords(text, [&](const std::string& word) { return withoutPreciseBelow400(word, version); });
  return own;
}

std::vector<std::string> storageDefines(int first) {
  std::vector<std::string> defines;
  for (int i = 0; i < kListBlocks; ++i)
    defines.push_back("PLD_STORAGE_" + std::to_string(i) + " " + storageLayout(first + i));
  return defines;
}

std::string seamMark(const Permutation& permutation, pld_stage stage) {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  for (const std::string& define : seamDefines(permutation, stage))
    for (const char c : define + '\n') hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  char mark[20];
  std::snprintf(mark, sizeof(mark), "pldScale_%08x", hash);
  return mark;
}

const char* casterMark(bool coloured) {
  return coloured ? "pldShadowMetric_coloured" : "pldShadowMetric_grey";
}

std::string seamText(const Permutation& permutation, pld_stage stage, int version, const SeamPlaces& places) {
  std::vector<std::string> defines = seamDefines(permutation, stage);
  defines.push_back("SCALE " + seamMark(permutation, stage));
  return hostText("gl/seam.glsl", defines, version, places, {"PLD_SEAM", "pld_", ""});
}

std::string casterText(bool coloured, int version, const SeamPlaces& places) {
  std::vector<std::string> defines{std::string("METRIC ") + casterMark(coloured)};
  if (!coloured) defines.emplace_back("GREY");
  return hostText("gl/caster_seam.glsl", defines, version, places, {"PLD_CASTER_SEAM", "pld_c_", "PLD_C_"});
}

std::string shadowText(const ShadowShape& shape, int version, const SeamPlaces& places) {
  const auto define = [](const char* name, int value) { return std::string(name) + " " + std::to_string(value); };
  return hostText("gl/shadow_seam.glsl",
                  {define("LIGHTS", shape.lights), define("FACES", shape.faces), define("EDGE", shape.edge),
                   define("CHANNELS", shape.channels)},
                  version, places, {"PLD_SHADOW_SEAM", "pld_s_", "PLD_S_"});
}

}  // namespace pellucid::c
