#include "composite/sequence/frame_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>

namespace pellucid {
namespace {

namespace fs = std::filesystem;

constexpr int kMostDigits = 9;

struct Place {
  std::size_t length = 0;  // in the text; 0 where no place begins
  int digits = 0;
  bool unmistakable = true;
};

std::size_t digitsEnd(const std::string& text, std::size_t at) {
  while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
  return at;
}

// "04d" of %04d, "4" of $F4: a number of one digit, with a zero before it where that is asked for.
Place placeAt(const std::string& text, std::size_t at) {
  const char sign = text[at];
  if (sign == '#' || sign == '@') {
    const std::size_t end = std::min(text.find_first_not_of(sign, at), text.size());
    const int count = static_cast<int>(std::min<std::size_t>(end - at, kMostDigits));
    if (count > 1) return {end - at, count, true};
    return sign == '#' ? Place{1, 4, true} : Place{1, 0, false};
  }
  if (sign == '%') {
    const std::size_t end = digitsEnd(text, at + 1);
    if (end >= text.size() || text[end] != 'd') return {};
    if (end == at + 1) return {2, 0, true};
    if (end != at + 3 || text[at + 1] != '0' || text[at + 2] == '0') return {};
    return {4, text[at + 2] - '0', true};
  }
  if (sign == '$' && at + 1 < text.size() && text[at + 1] == 'F') {
    const std::size_t end = digitsEnd(text, at + 2);
    const bool goesOn = end < text.size() && (std::isalpha(static_cast<unsigned char>(text[end])) || text[end] == '_');
    if (end > at + 3 || goesOn) return {};  // $FILE is another name
    return {end - at, end == at + 2 ? 0 : text[at + 2] - '0', true};
  }
  return {};
}

}  // namespace

FramePattern::FramePattern(std::string text) : text_(std::move(text)), pieces_(1) {
  for (std::size_t at = 0; at < text_.size();) {
    const Place place = placeAt(text_, at);
    if (place.length == 0) {
      pieces_.back().literal += text_[at++];
      continue;
    }
    pieces_.back().digits = place.digits;
    pieces_.emplace_back();
    unmistakable_ = unmistakable_ || place.unmistakable;
    at += place.length;
  }
}

std::string FramePattern::named(int frame, int more) const {
  std::string path;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    path += pieces_[i].literal;
    if (i + 1 < pieces_.size()) path += fmt::format("{:0{}d}", frame, pieces_[i].digits + more);
  }
  return path;
}

std::string FramePattern::inputAt(int frame, const std::function<std::string(const std::string&)>& fileOf) const {
  const std::string usual = named(frame, 0), other = named(frame, 1);
  std::error_code unused;
  const bool onlyOther = frame < 0 && !fs::exists(fileOf(usual), unused) && fs::exists(fileOf(other), unused);
  return onlyOther ? other : usual;
}

std::vector<int> FramePattern::onDisk() const {
  std::vector<int> frames;
  if (!any()) return frames;
  // The folder that holds the first place, and how the name begins in it.
  const std::string& first = pieces_[0].literal;
  const auto slash = first.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : slash == 0 ? "/" : first.substr(0, slash);
  const std::string beginning = slash == std::string::npos ? first : first.substr(slash + 1);
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.rfind(beginning, 0) != 0) continue;
    int frame = 0;
    const auto [next, failed] = std::from_chars(name.data() + beginning.size(), name.data() + name.size(), frame);
    std::error_code unused;
    const auto itself = [](const std::string& file) { return file; };
    if (failed == std::errc() && fs::is_regular_file(inputAt(frame, itself), unused)) frames.push_back(frame);
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

FramePattern inputPattern(const std::string& path) {
  std::error_code unused;
  const FramePattern pattern(path);
  return pattern.any() && fs::exists(path, unused) ? FramePattern("") : pattern;
}

}  // namespace pellucid
