#include "composite/sequence/frame_range.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <set>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr int kMost = 1000000;  // frames, and the largest number of one

// Takes a number, or a sign, from the front of what is left of a text.
class Reader {
 public:
  Reader(const std::string& text, const std::string& flag)
      : text_(text), flag_(flag), at_(text.data()), end_(text.data() + text.size()) {}
  bool done() const { return at_ == end_; }
  bool takes(char sign) {
    if (done() || *at_ != sign) return false;
    ++at_;
    return true;
  }
  int number() {
    int value = 0;
    const auto [next, error] = std::from_chars(at_, end_, value);
    if (error != std::errc() || std::abs(static_cast<long>(value)) > kMost) refuse();
    at_ = next;
    return value;
  }
  [[noreturn]] void refuse() const {
    throw UsageError(
        fmt::format("{}: found '{}', expected frames such as 1001-1100x2,1200, none beyond {}", flag_, text_, kMost));
  }

 private:
  const std::string &text_, &flag_;
  const char *at_, *end_;
};

}  // namespace

FrameRange parseFrames(const std::string& text, const std::string& flag) {
  FrameRange range;
  std::set<int> seen, twice;
  Reader reader(text, flag);
  do {
    const int first = reader.number();
    const int last = reader.takes('-') ? reader.number() : first;
    const int step = reader.takes('x') ? reader.number() : 1;
    if (step < 1) reader.refuse();
    for (int frame = first; first <= last ? frame <= last : frame >= last; frame += first <= last ? step : -step) {
      if (seen.insert(frame).second)
        range.frames.push_back(frame);
      else if (twice.insert(frame).second)
        range.duplicates.push_back(frame);
      if (range.frames.size() > static_cast<std::size_t>(kMost)) reader.refuse();
    }
  } while (reader.takes(','));
  if (!reader.done()) reader.refuse();
  return range;
}

std::string framesText(const std::vector<int>& frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t end = i + 1;
    while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
    if (!text.empty()) text += ", ";
    text += std::to_string(frames[i]);
    if (end - i > 1) text += (end - i > 2 ? "-" : ", ") + std::to_string(frames[end - 1]);
    i = end;
  }
  return text;
}

}  // namespace pellucid
