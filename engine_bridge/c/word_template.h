// A text whose words are replaced more than once: read through when it is made, and only put together afterwards.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine_bridge/c/text_words.h"

namespace pellucid::c {

class WordTemplate {
 public:
  //   mayChange(word)  whether write() may be asked for another
  template <class F>
  WordTemplate(std::string_view text, F mayChange) {
    std::unordered_map<std::string_view, uint32_t> known;  // of `text`
    text_ = withWords(text, [&](std::string_view word, std::string& out) {
      if (mayChange(word)) {
        const auto [at, isNew] = known.try_emplace(word, static_cast<uint32_t>(words_.size()));
        if (isNew) words_.emplace_back(word);
        places_.push_back({static_cast<uint32_t>(out.size()), at->second});
      }
      out += word;
    });
  }

  std::size_t size() const { return text_.size(); }

  // Appends the text as withWords() has it: changed(word, out) is called once for each word that may change.
  template <class F>
  void write(std::string& out, F changed) const {
    std::vector<std::string> now(words_.size());
    for (std::size_t i = 0; i < now.size(); ++i) changed(std::string_view(words_[i]), now[i]);
    std::size_t from = 0;
    for (const Place& place : places_) {
      const std::string &before = words_[place.word], &after = now[place.word];
      if (after == before) continue;
      out.append(text_, from, place.at - from).append(after);
      from = place.at + before.size();
    }
    out.append(text_, from);
  }

 private:
  struct Place {
    uint32_t at, word;
  };
  std::string text_;  // without comments
  std::vector<std::string> words_;
  std::vector<Place> places_;
};

}  // namespace pellucid::c
