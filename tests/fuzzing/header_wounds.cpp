#include "tests/fuzzing/header_wounds.h"

#include <limits>

namespace pellucid::test {
namespace {

constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-:/ #";

char letter(Random& random) {
  return kLetters[random.below(static_cast<std::uint32_t>(std::string(kLetters).size()))];
}

std::size_t below(Random& random, std::size_t count) {
  return random.below(static_cast<std::uint32_t>(count));
}

// A letter changed, left out, put in or doubled; a case turned; a word of the path dropped.
std::string misspelt(std::string name, Random& random) {
  if (name.empty()) return std::string(1, letter(random));
  const std::size_t at = below(random, name.size());
  switch (random.below(6)) {
    case 0:
      name[at] = letter(random);
      break;
    case 1:
      if (name.size() > 1) name.erase(at, 1);
      break;
    case 2:
      name.insert(at, 1, letter(random));
      break;
    case 3:
      name.insert(at, 1, name[at]);
      break;
    case 4:
      name[at] = static_cast<char>(name[at] ^ 0x20);
      break;
    default:
      if (const std::size_t dot = name.find('.'); dot != std::string::npos && dot + 1 < name.size())
        name.erase(0, dot + 1);
  }
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ') c = '_';
  return name;
}

template <class Map>
void renameKey(Map& map, Random& random) {
  if (map.empty()) return;
  auto chosen = std::next(map.begin(), static_cast<std::ptrdiff_t>(below(random, map.size())));
  auto node = map.extract(chosen);
  node.key() = misspelt(node.key(), random);
  map.insert(std::move(node));
}

void woundMatrix(Part& part, Random& random) {
  if (part.matrices.empty()) return;
  auto chosen = std::next(part.matrices.begin(), static_cast<std::ptrdiff_t>(below(random, part.matrices.size())));
  constexpr float limits[] = {0.0f,
                              -1.0f,
                              1e30f,
                              std::numeric_limits<float>::quiet_NaN(),
                              std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::denorm_min()};
  switch (random.below(4)) {
    case 0:
      part.matrices.erase(chosen);
      break;
    case 1:  // a text of the same name
      part.strings[chosen->first] = "1 0 0 0";
      part.matrices.erase(chosen);
      break;
    case 2:
      chosen->second.assign(16, limits[random.below(6)]);
      break;
    default:
      chosen->second[below(random, 16)] = limits[random.below(6)];
  }
}

void woundPart(Part& part, Random& random) {
  switch (random.below(10)) {
    case 0:
      renameKey(part.strings, random);
      break;
    case 1:
      if (!part.strings.empty()) part.strings.begin()->second = misspelt(part.strings.begin()->second, random);
      break;
    case 2:
      if (!part.strings.empty()) part.strings.erase(part.strings.begin());
      break;
    case 3:
      woundMatrix(part, random);
      break;
    case 4:
      part.strings["chromaticities"] = "0.64 0.33 0.3 0.6";
      break;
    case 5:
      part.strings["pellucid:filter"] = misspelt("box:0.5", random);
      break;
    case 6:
      part.view = random.below(2) ? "left" : misspelt("right", random);
      break;
    default: {
      std::string& name = part.planes[below(random, part.planes.size())].name;
      name = misspelt(name, random);
    }
  }
}

}  // namespace

void wound(std::vector<Part>& parts, Random& random) {
  const std::uint32_t wounds = 1 + random.below(3);
  for (std::uint32_t i = 0; i < wounds; ++i) woundPart(parts[below(random, parts.size())], random);
}

void woundBytes(std::string& file, std::size_t header, Random& random) {
  const std::uint32_t wounds = 1 + random.below(3);
  for (std::uint32_t i = 0; i < wounds; ++i) {
    const std::size_t at = 8 + below(random, header - 8);
    file[at] = random.below(2) ? static_cast<char>(random.below(256))
                               : static_cast<char>(file[at] ^ static_cast<char>(1u << random.below(8)));
  }
}

std::string woundedText(std::string text, Random& random) {
  const std::uint32_t wounds = 1 + random.below(3);
  for (std::uint32_t i = 0; i < wounds && !text.empty(); ++i) {
    const std::size_t at = below(random, text.size()), length = 1 + below(random, 24);
    switch (random.below(5)) {
      case 0:
        text[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(below(random, text.size()), text.substr(at, length));
        break;
      case 3:
        text[at] = "0123456789-eE.,:{}[]!&*"[random.below(23)];
        break;
      default:
        text[at] = letter(random);
    }
  }
  return text;
}

}  // namespace pellucid::test
