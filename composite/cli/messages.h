// Messages go to stderr, results to stdout.
#pragma once
#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "composite/pipeline/journal.h"

namespace pellucid::cli {

void setUpMessages();
void say(const std::string& note);
void say(const std::vector<std::string>& notes);
// While it lives, what this thread says is kept there and not printed: for skins that have no stderr of their own.
class Listener {
 public:
  explicit Listener(std::vector<std::string>& notes);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

 private:
  std::vector<std::string>* before_;
};
template <class... Values>
void note(fmt::format_string<Values...> text, Values&&... values) {
  say(fmt::format(text, std::forward<Values>(values)...));
}
void sayError(const std::string& sentence);
inline Journal journal() {
  return Journal([](const std::string& note) { say(note); });
}

// Lines are JSON objects from now on: time (UTC), level, message, and the frame where there is one.
void sayAsJson();
bool saysJson();
// A message as it would stand on stderr, with its end of line.
//   frame  its name, or ""
std::string messageLine(const std::string& level, const std::string& sentence, const std::string& frame = "");
// Notes go there instead; null: to stderr.
void hearNotes(std::function<void(const std::string&)> ear);

}  // namespace pellucid::cli
