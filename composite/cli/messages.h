// Messages go to stderr, results to stdout.
#pragma once
#include <fmt/format.h>

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
inline Journal journal() {
  return Journal([](const std::string& note) { say(note); });
}

}  // namespace pellucid::cli
