// Keywords of Python as the program's own flags: the table of a verb's flags,
// and the words that Python made of keywords, parsed by the registrations that
// the program parses its command line with.
#pragma once
#include <pybind11/pybind11.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/cli/verb_flags.h"

namespace pellucid::python {

using Words = std::vector<std::string>;

// `composite` of one view: arrays and one result belong to one.
struct OneViewFlags : cli::CompositeFlags {
  void addTo(CLI::App& verb) { cli::CompositeFlags::addTo(verb, false); }
};

// The verb's flags for a caller who need not name an output.
void loosen(CLI::App& verb);
// Parses, and checks what is named as outputs. Throws UsageError and
// ResourceError.
void parseWords(CLI::App& verb, const Words& words);

template <class Flags>
struct Parsed {
  CLI::App verb;
  Flags flags;
  //   inMemory  the opaque picture is not a file: the first file is a scene
  Parsed(const std::string& name, const Words& words, bool inMemory = false) : verb("", name) {
    flags.addTo(verb);
    loosen(verb);
    if (inMemory) verb.remove_option(verb.get_option("opaque"));
    parseWords(verb, words);
    if constexpr (requires { flags.model.apply(verb); }) flags.model.apply(verb);
  }
  Parsed(const Parsed&) = delete;
  Parsed& operator=(const Parsed&) = delete;
};

// A row for every flag of the verb that is a keyword: a dict of name, flag,
// names, group, help, value, type, default, switch and many. Throws UsageError
// for an unknown verb.
pybind11::list optionsOf(const std::string& verb);
// The nearest of the names, or "".
std::string nearest(const std::string& text, const std::vector<std::string>& names);

}  // namespace pellucid::python
