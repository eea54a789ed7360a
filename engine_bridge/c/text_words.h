// GLSL as words: what a text declares, and the same text with other words in their places.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_set>

namespace pellucid::c {

constexpr bool isWordLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// The same, looked up: texts are long.
struct WordLetters {
  bool is[256] = {};
  constexpr WordLetters() {
    for (int c = 0; c < 256; ++c) is[c] = isWordLetter(static_cast<char>(c));
  }
  constexpr bool operator()(char c) const { return is[static_cast<unsigned char>(c)]; }
};
inline constexpr WordLetters kWordLetters;

// Every word of `text`, as changed(word, out) writes it. Comments go: a compiler has no use for them, and a log shows
// the lines.
template <class F>
std::string withWords(std::string_view text, F changed) {
  std::string out;
  out.reserve(text.size() + text.size() / 4);
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    if (text[i] == '/' && i + 1 < text.size() && text[i + 1] == '/') {
      end = std::min(text.find('\n', i), text.size());
      while (!out.empty() && out.back() == ' ') out.pop_back();
    } else if (kWordLetters(text[i])) {
      while (end < text.size() && kWordLetters(text[end])) ++end;
      changed(text.substr(i, end - i), out);
    } else {
      do ++end;
      while (end < text.size() && !kWordLetters(text[end]) && text[end] != '/');
      out.append(text.substr(i, end - i));
    }
    i = end;
  }
  return out;
}

// What a text declares outside of functions: functions, structs, outputs, constants, variables, macros, and macros that
// it looks for. Outputs may stand in a macro, several of them in one line. The words are those of `text`.
std::unordered_set<std::string_view> declaredIn(std::string_view text);

}  // namespace pellucid::c
