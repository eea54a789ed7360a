#include "engine_bridge/scene/uri.h"

#include <algorithm>

namespace pellucid::gltf {

namespace {

int base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

bool isSpace(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// `word` in lower case.
bool sameWord(std::string_view text, std::string_view word) {
  return text.size() == word.size() &&
         std::equal(text.begin(), text.end(), word.begin(), [](char a, char b) { return lower(a) == b; });
}

constexpr std::string_view kData = "data:", kBase64 = "base64";

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

bool decodeBase64(std::string_view text, std::vector<std::uint8_t>& bytes) {
  bytes.clear();
  text = trimmed(text);
  for (int padding = 0; padding < 2 && !text.empty() && text.back() == '='; ++padding)
    text = trimmed(text.substr(0, text.size() - 1));
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t window = 0;
  int bits = 0;
  std::size_t digits = 0;
  for (const char c : text) {
    if (isSpace(c)) continue;
    const int digit = base64Digit(c);
    if (digit < 0) return false;
    ++digits;
    window = ((window << 6) | static_cast<std::uint32_t>(digit)) & 0xffffffu;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>((window >> bits) & 0xffu));
  }
  return digits % 4 != 1;
}

std::string decodePercent(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escaped =
        text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0;
    if (!escaped) {
      decoded.push_back(text[i]);
      continue;
    }
    decoded.push_back(static_cast<char>(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2])));
    i += 2;
  }
  return decoded;
}

bool isDataUri(std::string_view uri) {
  return sameWord(trimmed(uri).substr(0, kData.size()), kData);
}

bool decodeDataUri(std::string_view uri, std::vector<std::uint8_t>& bytes) {
  if (!isDataUri(uri)) return false;
  const std::string_view all = trimmed(uri).substr(kData.size());
  const std::size_t comma = all.find(',');
  if (comma == std::string_view::npos) return false;
  const std::string_view head = all.substr(0, comma), content = all.substr(comma + 1);
  const std::size_t last = head.rfind(';');
  if (last != std::string_view::npos && sameWord(trimmed(head.substr(last + 1)), kBase64)) {
    // The URI's own escapes come off before what it holds is read (RFC 3986, 2.4).
    if (content.find('%') == std::string_view::npos) return decodeBase64(content, bytes);
    return decodeBase64(decodePercent(content), bytes);
  }
  const std::string plain = decodePercent(content);
  bytes.assign(plain.begin(), plain.end());
  return true;
}

std::string_view uriScheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  // One letter before a colon is a drive, not a scheme.
  if (colon == std::string_view::npos || colon < 2 || uri.find('/') < colon) return {};
  for (const char c : uri.substr(0, colon)) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!letter && !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != '.') return {};
  }
  return uri.substr(0, colon);
}

}  // namespace pellucid::gltf
