#include "shaders/shader_source.h"

#include <set>
#include <sstream>
#include <stdexcept>

namespace pellucid {
namespace {

const char* textOf(const std::string& name) {
  for (const ShaderText* entry = kShaderTexts; entry->name; ++entry)
    if (name == entry->name) return entry->text;
  throw std::logic_error("no shader named " + name);
}

void append(const std::string& name, std::set<std::string>& seen, std::ostringstream& out) {
  if (!seen.insert(name).second) return;
  std::istringstream lines(textOf(name));
  for (std::string line; std::getline(lines, line);) {
    const std::string key = "#include \"";
    if (line == "#pragma once") continue;
    if (line.rfind(key, 0) == 0)
      append(line.substr(key.size(), line.rfind('"') - key.size()), seen, out);
    else
      out << line << '\n';
  }
}

}  // namespace

std::string shaderSource(const std::string& name, const std::vector<std::string>& defines) {
  std::ostringstream out;
  out << "#version 450 core\n#define PLD_FN\n";
  for (const std::string& define : defines) out << "#define " << define << '\n';
  std::set<std::string> seen;
  append(name, seen, out);
  return out.str();
}

}  // namespace pellucid
