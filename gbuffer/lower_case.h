// Names that are compared whatever their case.
#pragma once
#include <string>

namespace pellucid {

// ASCII letters alone, whatever the locale.
inline std::string lowerCase(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace pellucid
