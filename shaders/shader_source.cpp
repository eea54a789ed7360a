#include "shaders/shader_source.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string_view>

namespace pellucid {
namespace {

const char* textOf(const std::string& name) {
  for (const ShaderText* entry = kShaderTexts; entry->name; ++entry)
    if (name == entry->name) return entry->text;
  throw std::logic_error("no shader named " + name);
}

using Parts = std::vector<std::string_view>;

void append(const std::string& name, std::set<std::string>& seen, Parts& parts) {
  if (!seen.insert(name).second) return;
  constexpr std::string_view key = "#include \"", once = "#pragma once\n";
  const std::string_view text = textOf(name);
  std::size_t begin = text.substr(0, once.size()) == once ? once.size() : 0;
  const auto isLine = [&](std::size_t at) { return at == 0 || text[at - 1] == '\n'; };
  for (std::size_t at = text.find(key, begin); at != std::string_view::npos; at = text.find(key, at + 1)) {
    if (!isLine(at)) continue;
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view included = text.substr(at + key.size(), end - at - key.size());
    if (at > begin) parts.push_back(text.substr(begin, at - begin));
    append(std::string(included.substr(0, included.rfind('"'))), seen, parts);
    begin = std::min(end + 1, text.size());
  }
  if (begin < text.size()) parts.push_back(text.substr(begin));
}

}  // namespace

std::vector<std::string_view> shaderParts(const std::string& name) {
  std::set<std::string> seen;
  Parts parts;
  append(name, seen, parts);
  return parts;
}

std::string shaderSource(const std::string& name, const std::vector<std::string>& defines) {
  std::string out = "#version 450 core\n#define PLD_FN\n";
  for (const std::string& define : defines) out.append("#define ").append(define) += '\n';
  for (const std::string_view part : shaderParts(name)) out += part;
  return out;
}

}  // namespace pellucid
