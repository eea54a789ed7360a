#include "composite/cli/suggest.h"

#include <fmt/format.h>

#include <algorithm>

#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

std::vector<const CLI::App*> verbsOf(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

const CLI::Option* optionOf(const CLI::App& verb, const std::string& flag) {
  for (const CLI::Option* option : verb.get_options())
    if (option->check_name(flag)) return option;
  return nullptr;
}

// "composite", "composite and study", "a, b and c": the verbs that have the flag.
std::string verbsWith(const CLI::App& app, const std::string& flag) {
  std::vector<std::string> names;
  for (const CLI::App* verb : verbsOf(app))
    if (optionOf(*verb, flag)) names.push_back(verb->get_name());
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

[[noreturn]] void refuseFlag(const CLI::App& app, const CLI::App& verb, const std::string& flag) {
  const bool top = &app == &verb;
  const std::string who = top ? app.get_name() : app.get_name() + " " + verb.get_name();
  const std::string others = verbsWith(app, flag), near = nearestName(flag, flagsOf(verb));
  if (!others.empty())
    throw UsageError(fmt::format("{}: found the flag {}, which only {} take{}{}", who, flag, others,
                                 others.find(' ') == std::string::npos ? "s" : "",
                                 top ? ": it stands after the verb" : ""));
  throw UsageError(fmt::format(
      "{}: found the flag {}, which does not exist: {}", who, flag,
      near.empty() ? fmt::format("{} --help lists those that do", who) : fmt::format("did you mean {}?", near)));
}

}  // namespace

std::size_t editDistance(const std::string& a, const std::string& b) {
  // Rows of the table of distances between beginnings of both: the one before the last, the last, this one.
  std::vector<std::size_t> older, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    older = last;
    last = row;
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); ++k) {
      row[k] = std::min({last[k] + 1, row[k - 1] + 1, last[k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1)});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1]) row[k] = std::min(row[k], older[k - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string nearestName(const std::string& text, const std::vector<std::string>& names) {
  constexpr std::size_t kBeginning = 5;  // characters, the dashes of a flag among them
  std::string nearest;
  std::size_t least = SIZE_MAX;
  for (const std::string& name : names) {
    const bool begins = text.size() >= kBeginning && name.rfind(text, 0) == 0;
    const std::size_t distance = begins ? 1 : editDistance(text, name);
    const std::size_t letters = std::max(text.size(), name.size());
    if (distance <= std::max<std::size_t>(1, letters / 3) && distance < least) {
      least = distance;
      nearest = name;
    }
  }
  return nearest;
}

std::vector<std::string> flagsOf(const CLI::App& verb) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
    for (const std::string& name : option->get_snames()) flags.push_back("-" + name);
  }
  return flags;
}

void checkWords(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* verb = &app;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;  // the rest are files
    const bool isFlag = word.size() > 1 && word[0] == '-';
    if (!isFlag && verb == &app) {
      std::vector<std::string> names;
      for (const CLI::App* each : verbsOf(app)) {
        names.push_back(each->get_name());
        if (each->get_name() == word) verb = each;
      }
      if (verb != &app) continue;
      const std::string near = nearestName(word, names);
      throw UsageError(fmt::format("found the verb '{}', which does not exist: {}", word,
                                   near.empty() ? fmt::format("expected one of {}", fmt::join(names, ", "))
                                                : fmt::format("did you mean {}?", near)));
    }
    if (!isFlag) continue;
    const bool isLong = word[1] == '-';
    const std::string flag = isLong ? word.substr(0, word.find('=')) : word.substr(0, 2);
    const CLI::Option* option = optionOf(*verb, flag);
    if (!option) refuseFlag(app, *verb, flag);
    const bool holdsValue = isLong ? word.size() > flag.size() : word.size() > 2;
    i += std::max(0, option->get_items_expected_min() - (holdsValue ? 1 : 0));
    if (verb == &app) return;  // --help, --version: they end the program
  }
  if (verb == &app) throw UsageError("found no verb: pellucid --help lists them");
}

}  // namespace pellucid::cli
