#include "engine_bridge/c/text_words.h"

#include <cctype>
#include <initializer_list>

namespace pellucid::c {
namespace {

// Takes words and signs from the front of a line; what does not fit leaves it as it was.
class LineReader {
 public:
  explicit LineReader(std::string_view line) : rest_(line) {}

  bool take(std::string_view sign) {
    if (rest_.substr(0, sign.size()) != sign) return false;
    rest_.remove_prefix(sign.size());
    return true;
  }
  // Empty where none begins here.
  std::string_view word() {
    std::size_t end = 0;
    while (end < rest_.size() && kWordLetters(rest_[end])) ++end;
    const std::string_view found = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return found;
  }
  bool begins(std::string_view sign) const { return rest_.substr(0, sign.size()) == sign; }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

bool isMacroOfOurs(std::string_view name) {
  return !name.empty() && name.substr(0, 3) != "GL_";
}

bool isPlainType(std::string_view type) {
  return type == "bool" || type == "float" ||
         (type.size() == 4 && type.substr(0, 3) == "vec" && std::isdigit(static_cast<unsigned char>(type[3])));
}

// The name that a line declares at its beginning, empty for none.
std::string_view declaredBy(std::string_view line) {
  LineReader directive(line);
  while (directive.take(" ")) continue;
  if (directive.take("#define ") || directive.take("#ifdef ") || directive.take("#ifndef ")) {
    const std::string_view name = directive.word();
    return isMacroOfOurs(name) ? name : std::string_view();
  }
  LineReader reader(line);
  reader.take("PLD_FN ");
  std::string_view type = reader.word();
  if (type.empty() || std::isdigit(static_cast<unsigned char>(type[0])) || type[0] == '_' || !reader.take(" "))
    return {};
  if (type == "const") {
    if (reader.word().empty() || !reader.take(" ")) return {};
    const std::string_view name = reader.word();
    return reader.begins(" =") ? name : std::string_view();
  }
  const std::string_view name = reader.word();
  if (type == "struct" || reader.begins("(")) return name;
  return isPlainType(type) && (reader.begins(" =") || reader.begins(";")) ? name : std::string_view();
}

// Calls found(name) for what stands behind every `sign` of a line.
template <class F>
void behindEach(std::string_view line, std::string_view sign, F found) {
  for (std::size_t at = line.find(sign); at != std::string_view::npos; at = line.find(sign, at + 1))
    found(LineReader(line.substr(at + sign.size())));
}

}  // namespace

std::unordered_set<std::string_view> declaredIn(std::string_view text) {
  std::unordered_set<std::string_view> names;
  names.reserve(1024);
  const auto add = [&](std::string_view name) {
    if (!name.empty()) names.insert(name);
  };
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    add(declaredBy(line));
    behindEach(line, "layout(location = ", [&](LineReader reader) {
      reader.word();
      if (!reader.take(") out ") || reader.word().empty() || !reader.take(" ")) return;
      const std::string_view name = reader.word();
      if (reader.begins(";")) add(name);
    });
    behindEach(line, "defined(", [&](LineReader reader) {
      const std::string_view name = reader.word();
      if (reader.begins(")") && isMacroOfOurs(name)) add(name);
    });
  }
  return names;
}

}  // namespace pellucid::c
