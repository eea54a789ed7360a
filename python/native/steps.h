// The other verbs on files, with what they found as arrays and plain objects.
// Each takes the words of its verb, and works without Python's lock.
#pragma once
#include <pybind11/pybind11.h>

#include "python/native/words.h"

namespace pellucid::python {

pybind11::dict accumulate(const Words& words);
pybind11::dict resolve(const Words& words);
pybind11::dict flatten(const Words& words);
pybind11::dict compare(const Words& words);
pybind11::dict study(const Words& words);

}  // namespace pellucid::python
