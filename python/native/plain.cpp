#include "python/native/plain.h"

#include <pybind11/stl.h>

#include <nlohmann/json.hpp>

#include "gbuffer/errors.h"
#include "gbuffer/tiers.h"
#include "gbuffer/weight_text.h"

namespace py = pybind11;

namespace pellucid::python {
namespace {

struct Kind {
  int exitCode;
  const char *name, *doc;
  PyObject* also;  // a builtin that it is, too
};

// By exit code; lives as long as the process, as Python's own exceptions do.
PyObject* kinds[7] = {};

PyObject* made(const std::string& name, const char* doc, PyObject* bases, int exitCode) {
  py::dict members;
  members["exit_code"] = exitCode;
  members["__module__"] = "pellucid";
  return PyErr_NewExceptionWithDoc(("pellucid." + name).c_str(), doc, bases, members.ptr());
}

}  // namespace

py::object plainOf(const nlohmann::json& value) {
  return py::module_::import("json").attr("loads")(value.dump());
}

py::dict plainOf(const Plan& plan, const ShotFacts& facts) {
  py::dict plain;
  plain["method"] = plan.method;
  plain["method_reason"] = plan.methodReason;
  plain["route"] = nameOf(plan.route);
  for (const PrecisionTier& row : kTiers)
    if (row.tier == plan.tier) plain["precision"] = row.name;
  plain["weight"] = weightText(plan.pass.weight);
  plain["fits_weight"] = plan.fitsWeight;
  plain["passes"] = plan.passes;
  plain["edges"] = plan.edges;
  plain["fog"] = plan.fog;
  plain["low_resolution"] = plan.lowResolution;
  plain["bytes"] = plan.bytes;
  plain["notes"] = plan.notes;
  plain["lines"] = describe(plan, facts);
  return plain;
}

void addErrors(py::module_& module) {
  const Kind rows[] = {
      {2, "UsageError", "An option that is unknown, malformed or cannot be honoured.", PyExc_ValueError},
      {3, "InputError", "A file that is missing, unreadable or damaged.", nullptr},
      {4, "MeaningError",
       "An input that contradicts itself, or lacks what is needed: a depth, a "
       "camera.",
       PyExc_ValueError},
      {6, "ResourceError", "Disk, memory or the GL device ran out.", nullptr},
  };
  PyObject* base =
      made("Error", "Any trouble that the program reports. exit_code is the program's.", PyExc_RuntimeError, 1);
  for (PyObject*& kind : kinds) kind = base;
  module.attr("Error") = py::reinterpret_borrow<py::object>(base);
  for (const Kind& row : rows) {
    py::object bases = row.also ? py::object(py::make_tuple(py::handle(base), py::handle(row.also)))
                                : py::reinterpret_borrow<py::object>(base);
    kinds[row.exitCode] = made(row.name, row.doc, bases.ptr(), row.exitCode);
    module.attr(row.name) = py::reinterpret_borrow<py::object>(kinds[row.exitCode]);
  }
  py::register_exception_translator([](std::exception_ptr raised) {
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const Error& error) {
      const int code = error.exitCode();
      PyErr_SetString(kinds[code >= 0 && code < 7 ? code : 1], error.what());
    }
  });
}

}  // namespace pellucid::python
