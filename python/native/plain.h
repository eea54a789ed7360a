// Plans, reports and trouble as plain objects of Python.
#pragma once
#include <pybind11/pybind11.h>

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "composite/pipeline/plan.h"

namespace pellucid::python {

pybind11::object plainOf(const nlohmann::json& value);  // dicts, lists, numbers, strings
pybind11::dict plainOf(const Plan& plan, const ShotFacts& facts);

// Adds pellucid.Error and its kinds to the module, and has every Error of C++
// raised as its own.
void addErrors(pybind11::module_& module);

}  // namespace pellucid::python
