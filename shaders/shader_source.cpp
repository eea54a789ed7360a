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

void append(const std::string& name, std::set<std::string>& seen, std::string& out) {
  if (!seen.insert(name).second) return;
  constexpr std::string_view key = "#include \"";
  const std::string_view text = textOf(name);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    if (line == "#pragma once") continue;
    if (line.substr(0, key.size()) == key)
      append(std::string(line.substr(key.size(), line.rfind('"') - key.size())), seen, out);
    else
      out.append(line) += '\n';
  }
}

}  // namespace

std::string shaderSource(const std::string& name, const std::vector<std::string>& defines) {
  std::string out = "#version 450 core\n#define PLD_FN\n";
  for (const std::string& define : defines) out.append("#define ").append(define) += '\n';
  std::set<std::string> seen;
  append(name, seen, out);
  return out;
}

}  // namespace pellucid
