#include "engine_bridge/c/glsl_text.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <map>
#include <mutex>
#include <utility>

#include "engine_bridge/c/word_template.h"
#include "shaders/shader_source.h"

namespace pellucid::c {
namespace {

using Words = std::unordered_set<std::string_view>;

std::string definesText(const std::vector<std::string>& defines) {
  std::string text;
  for (const std::string& define : defines) text.append("#define ").append(define) += '\n';
  return text;
}

// GLSL 3.30 has no `precise`.
bool isMissing(std::string_view word, const GlslTarget& target) {
  return target.dialect == PLD_DIALECT_GL && target.version < 400 && word == "precise";
}

bool isPublic(std::string_view word) {
  for (const char* one : {"pldWriteCaster", "pldCasterIdentity", "pldShadow", "pldShadowOnOpaque"})
    if (word == one) return true;
  return false;
}

bool begins(std::string_view word, std::string_view with) {
  return word.substr(0, with.size()) == with;
}

// How the names of one text keep clear of the host's and of each other's.
struct Names {
  const char* guard;
  const char* prefix;     // of what the host does not call
  const char* constants;  // of constants, in place of PLD_; empty leaves them
};

// Of what a text declares itself: what it is called there. False where the word stays.
bool rename(std::string_view word, const Names& names, std::string& out) {
  if (begins(word, "PLD_")) {
    if (!names.constants[0]) return false;
    out.append(names.constants).append(word.substr(4));
    return true;
  }
  // Of the shared text pldExp() and its like are not the host's to call, but theirs is the name in the layers' seam.
  if (begins(word, "Pld") || (begins(word, "pld") && (!names.constants[0] || isPublic(word)))) return false;
  out.append(names.prefix).append(word);
  return true;
}

constexpr const char* kEsPrecision =
    "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
    "precision highp sampler2DArray;\n";

// Without the lines between `#ifdef PLD_MARKS` and its #endif: passes that keep no marks have the texts, and so the
// hashes, that they would have if there were none.
std::string withoutMarks(const std::string& text) {
  constexpr std::string_view section = "#ifdef PLD_MARKS\n";
  std::string out;
  int depth = 0;  // of conditions inside of a section
  for (std::size_t at = 0, end = 0; at < text.size(); at = end) {
    end = std::min(text.find('\n', at), text.size() - 1) + 1;
    const std::string_view line(text.data() + at, end - at);
    if (depth == 0 && line != section) {
      out.append(line);
      continue;
    }
    if (begins(line, "#if")) ++depth;
    if (begins(line, "#endif")) --depth;
  }
  return out;
}

// A file for hosts, read once in a process.
struct HostFile {
  HostFile(const HostFile&) = delete;
  HostFile& operator=(const HostFile&) = delete;
  HostFile(const std::string& file, bool marked)
      : text(marked ? wholeText(file) : withoutMarks(wholeText(file))),
        declared(declaredIn(text)),
        words(text, [](std::string_view word) { return !std::isdigit(static_cast<unsigned char>(word[0])); }) {}

  static std::string wholeText(const std::string& file) {
    std::string whole;
    for (const std::string_view part : shaderParts(file)) whole += part;
    return whole;
  }

  std::string text;
  Words declared;  // of `text`
  WordTemplate words;
};

const HostFile& hostFile(const std::string& file, bool marked) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, bool>, HostFile> files;
  const std::lock_guard lock(mutex);
  return files.try_emplace({file, marked}, file, marked).first->second;
}

std::string hostText(const std::string& file, std::vector<std::string> defines, const GlslTarget& target,
                     const SeamPlaces& at, const Names& names) {
  if (target.dialect == PLD_DIALECT_ES) defines.emplace_back("LOOKED_UP_LATE");
  const HostFile& body = hostFile(file, std::find(defines.begin(), defines.end(), "PLD_MARKS") != defines.end());
  const std::string head = definesText(defines);
  const Words defined = declaredIn(head);
  const auto place = [&](std::string_view word) {
    const int number = word.back() - '0';
    if (begins(word, "PLD_STORAGE_")) return layoutText(target, "std430", at.firstStorage + number);
    return target.placesBindings() ? layoutText(target, nullptr, at.firstUnit + number) : std::string();
  };
  const auto change = [&](std::string_view word, std::string& out) {
    const bool ours = word[0] == 'P' && begins(word, "PLD_");
    if ((ours && word == "PLD_FN") || isMissing(word, target)) return;
    if (ours && word == "PLD_FRAME_LAYOUT")
      out += layoutText(target, "std140", at.uniformBinding);
    else if (ours && (begins(word, "PLD_STORAGE_") || (begins(word, "PLD_UNIT_") && word.size() == 10)))
      out += place(word);
    else if ((!body.declared.count(word) && !defined.count(word)) || !rename(word, names, out))
      out += word;
  };
  std::string text = std::string("#ifndef ") + names.guard + "\n#define " + names.guard + "\n" +
                     (target.dialect == PLD_DIALECT_ES ? kEsPrecision : "") + withWords(head, change);
  text.reserve(text.size() + body.words.size() * 5 / 4);
  body.words.write(text, change);
  return text + "#endif\n";
}

std::string withoutFirstLine(const std::string& text) {
  return text.substr(text.find('\n') + 1);
}

// The text without `layout(binding = N) ` before samplers, which are told to found(name, N).
template <class F>
std::string withoutUnits(const std::string& text, F found) {
  constexpr std::string_view key = "layout(binding = ", kind = " uniform ";
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
    const std::size_t close = text.find(')', at), type = close + 1 + kind.size(), name = text.find(' ', type) + 1;
    if (text.compare(close + 1, kind.size(), kind) != 0) continue;
    found(text.substr(name, text.find(';', name) - name), std::stoi(text.substr(at + key.size())));
    out.append(text, from, at - from);
    from = close + 2;
  }
  return out.append(text, from);
}

// Without the loose uniforms, which begin their lines; samplers have a layout before them.
std::string withoutLooseUniforms(const std::string& text) {
  constexpr std::string_view key = "\nuniform ";
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at)) {
    out.append(text, from, at - from);
    from = at = text.find('\n', at + 1);
  }
  return out.append(text, from);
}

bool changesInStages(std::string_view word) {
  return word == "precise" || word == "gl_VertexID" || word == "binding" || begins(word, "PLD_STORAGE_");
}

using StageParts = std::vector<const WordTemplate*>;

// The parts of a full-screen stage without loose uniforms. Each is read once in a process: files share them.
const StageParts& stageParts(const std::string& file) {
  static std::mutex mutex;
  static std::map<const char*, WordTemplate> read;  // by where it lies in kShaderTexts
  static std::map<std::string, StageParts> files;
  const std::lock_guard lock(mutex);
  if (const auto found = files.find(file); found != files.end()) return found->second;
  StageParts parts;
  for (const std::string_view part : shaderParts(file)) {
    auto one = read.find(part.data());
    if (one == read.end()) {
      std::string whole(1, '\n');
      whole += part;
      const std::string text = withoutLooseUniforms(whole).substr(1);
      one = read.try_emplace(part.data(), text, changesInStages).first;
    }
    parts.push_back(&one->second);
  }
  return files.emplace(file, std::move(parts)).first->second;
}

}  // namespace

std::string layoutText(const GlslTarget& target, const char* packing, int binding) {
  std::string text = "layout(";
  if (packing) text += packing;
  if (!target.placesBindings()) return text + ")";
  if (packing) text += ", ";
  if (target.dialect == PLD_DIALECT_VULKAN) text += "set = " + std::to_string(target.set) + ", ";
  return text + "binding = " + std::to_string(binding) + ")";
}

OwnText ownText(const std::string& file, const std::vector<std::string>& defines, int version) {
  GlslTarget target;
  target.version = version;
  OwnText own;
  const std::string text =
      withoutUnits(withoutFirstLine(shaderSource(file, defines)), [&](const std::string& name, int unit) {
        own.samplers.push_back({name, unit});
      });
  own.text =
      "#version " + std::to_string(version) + " core\n" + withWords(text, [&](std::string_view word, std::string& out) {
        if (!isMissing(word, target)) out += word;
      });
  return own;
}

std::string recipeStageText(const std::string& file, const std::vector<std::string>& defines, const GlslTarget& target,
                            const std::string& block, int storage) {
  const bool es = target.dialect == PLD_DIALECT_ES, vulkan = target.dialect == PLD_DIALECT_VULKAN;
  const std::string set = "set = " + std::to_string(target.set) + ", ";
  const auto change = [&](std::string_view word, std::string& out) {
    if (isMissing(word, target)) return;
    if (word[0] == 'P' && begins(word, "PLD_STORAGE_"))
      out += layoutText(target, "std430", storage + word.back() - '0');
    else if (vulkan && word == "gl_VertexID")
      out += "gl_VertexIndex";
    else if (vulkan && word == "binding")
      out.append(set).append(word);
    else
      out.append(word);
  };
  std::string text = "#version " + std::to_string(target.version) +
                     (es       ? " es\n"
                      : vulkan ? "\n"
                               : " core\n") +
                     (es ? kEsPrecision : "") + block + withWords("\n#define PLD_FN\n" + definesText(defines), change);
  const StageParts& parts = stageParts(file);
  std::size_t size = text.size();
  for (const WordTemplate* part : parts) size += part->size() * 9 / 8;
  text.reserve(size);
  for (const WordTemplate* part : parts) part->write(text, change);
  return target.placesBindings() ? text : withoutUnits(text, [](const std::string&, int) {});
}

std::vector<std::string> storageDefines(int first) {
  std::vector<std::string> defines;
  for (int i = 0; i < kListBlocks; ++i)
    defines.push_back("PLD_STORAGE_" + std::to_string(i) + " layout(std430, binding = " + std::to_string(first + i) +
                      ")");
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

std::string seamText(const Permutation& permutation, pld_stage stage, const GlslTarget& target,
                     const SeamPlaces& places) {
  std::vector<std::string> defines = seamDefines(permutation, stage);
  defines.push_back("SCALE " + seamMark(permutation, stage));
  return hostText("gl/seam.glsl", defines, target, places, {"PLD_SEAM", "pld_", ""});
}

std::string casterText(bool coloured, const GlslTarget& target, const SeamPlaces& places) {
  std::vector<std::string> defines{std::string("METRIC ") + casterMark(coloured)};
  if (!coloured) defines.emplace_back("GREY");
  return hostText("gl/caster_seam.glsl", defines, target, places, {"PLD_CASTER_SEAM", "pld_c_", "PLD_C_"});
}

std::string shadowText(const ShadowShape& shape, const GlslTarget& target, const SeamPlaces& places) {
  const auto define = [](const char* name, int value) { return std::string(name) + " " + std::to_string(value); };
  return hostText("gl/shadow_seam.glsl",
                  {define("LIGHTS", shape.lights), define("FACES", shape.faces), define("EDGE", shape.edge),
                   define("CHANNELS", shape.channels)},
                  target, places, {"PLD_SHADOW_SEAM", "pld_s_", "PLD_S_"});
}

}  // namespace pellucid::c
