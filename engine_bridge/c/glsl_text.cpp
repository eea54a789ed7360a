#include "engine_bridge/c/glsl_text.h"

#include <algorithm>
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

// What a text declares outside of functions: functions, structs, outputs.
std::set<std::string> declaredIn(const std::string& text) {
  static const std::regex patterns[] = {
      std::regex(R"(^(?:PLD_FN )?[A-Za-z]\w* (\w+)\()"), std::regex(R"(^struct (\w+))"),
      std::regex(R"(^layout\(location = \d\) out \w+ (\w+);)")};
  std::set<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    for (const std::regex& pattern : patterns)
      if (std::smatch match; std::regex_search(line, match, pattern)) names.insert(match[1]);
  return names;
}

std::string withoutPreciseBelow400(const std::string& word, int version) {
  return version < 400 && word == "precise" ? std::string() : word;
}

}  // namespace

OwnText ownText(const std::string& file, const std::vector<std::string>& defines, int version) {
  static const std::regex bound(R"(layout\(binding = (\d+)\) (uniform sampler2D (\w+);))");
  OwnText own;
  std::istringstream lines(shaderSource(file, defines));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("#version", 0) == 0) continue;
    if (std::smatch match; std::regex_search(line, match, bound)) {
      own.samplers.push_back({match[3], std::stoi(match[1])});
      line = match[2];
    }
    text += line + '\n';
  }
  own.text = "#version " + std::to_string(version) + " core\n" +
             withWords(text, [&](const std::string& word) { return withoutPreciseBelow400(word, version); });
  return own;
}

std::string seamText(const Permutation& permutation, pld_stage stage, int version, int uniformBinding, int firstUnit) {
  const std::vector<std::string> defines = seamDefines(permutation, stage);
  std::string text = shaderSource("gl/seam.glsl", defines);
  text.erase(0, text.find('\n') + 1);             // #version
  text.erase(0, std::string("#define PLD_FN\n").size());
  std::set<std::string> own = declaredIn(text);
  for (const char* name : {"PUBLISHED", "GREY", "LEAN", "HALF", "FRONT_TAIL", "SCATTER", "REFRACTS", "DIFFUSES",
                                  "DISPERSION", "SOLIDS", "STAGE_SOLIDS", "STAGE_FRONT", "DEPTH_IN_SHADER", "UNCOUNTED",
                                  "WEIGHT", "NORMALISATION"})
    own.insert(name);
  const bool places = version >= 420;
  const auto unit = [&](int i) {
    return places ? "layout(binding = " + std::to_string(firstUnit + i) + ")" : std::string();
  };
  text = withWords(text, [&](const std::string& word) -> std::string {
    if (word == "PLD_FN") return {};
    if (word == "PLD_FRAME_LAYOUT")
      return places ? "layout(std140, binding = " + std::to_string(uniformBinding) + ")" : "layout(std140)";
    if (word == "PLD_UNIT_0") return unit(0);
    if (word == "PLD_UNIT_1") return unit(1);
    if (word == "PLD_UNIT_2") return unit(2);
    if (own.count(word) && word.rfind("pld", 0) != 0 && word.rfind("Pld", 0) != 0) return "pld_" + word;
    return withoutPreciseBelow400(word, version);
  });
  return "#ifndef PLD_SEAM\n#define PLD_SEAM\n" + text + "#endif\n";
}

}  // namespace pellucid::c
