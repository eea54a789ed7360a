// The native half of the Python module `pellucid`: python/pellucid/ makes words
// of keywords and documents what is here.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/results.h"
#include "python/native/arrays.h"
#include "python/native/plain.h"
#include "python/native/session.h"
#include "python/native/steps.h"

namespace py = pybind11;

namespace pellucid::python {
namespace {

using Shared = std::shared_ptr<const Outcome>;

py::dict viewsOfRun(const Shared& outcome) {
  const Result& result = outcome->result;
  const Window& data = result.dataWindow;
  py::dict found;
  found["picture"] = viewOf(result.picture.rgba, outcome);
  found["touched"] = viewOf(result.picture.touched, outcome);
  found["light"] = viewOf(result.veil.light, outcome);
  found["transmission"] = viewOf(result.veil.transmission, outcome);
  found["front_depth"] = viewOf(result.veil.frontZ, outcome);
  found["layers"] = viewsOf(result.layers, outcome);
  found["window"] = py::make_tuple(data.x0, data.y0, data.x1, data.y1);
  found["space"] = outcome->space;
  found["plan"] = plainOf(result.plan, outcome->facts);
  found["statistics"] = plainOf(cli::statisticsOf(result.stages, result.counts, result.device));
  const nlohmann::json errors = cli::errorsOf(result);
  found["error"] = errors.contains("error") ? plainOf(errors["error"]) : py::object(py::none());
  found["tolerance"] = errors.contains("tolerance") ? plainOf(errors["tolerance"]) : py::object(py::none());
  found["notes"] = outcome->notes;
  return found;
}

std::unique_ptr<Session> opened(const Words& words, std::shared_ptr<MemoryPicture> picture,
                                std::optional<Camera> camera) {
  const py::gil_scoped_release unlocked;
  return std::make_unique<Session>(words, std::move(picture), std::move(camera));
}

py::dict run(Session& session, const Words& words) {
  Shared outcome;
  {
    const py::gil_scoped_release unlocked;
    outcome = session.run(words);
  }
  return viewsOfRun(outcome);
}

py::dict plan(Session& session, const Words& words) {
  std::pair<Plan, ShotFacts> found;
  {
    const py::gil_scoped_release unlocked;
    found = session.plan(words);
  }
  return plainOf(found.first, found.second);
}

// GL contexts and scenes are given back without Python's lock.
void close(std::unique_ptr<Session>& session) {
  const py::gil_scoped_release unlocked;
  session.reset();
}

// Python's handle of a session, which may be closed before it is collected.
struct Handle {
  std::unique_ptr<Session> session;
  ~Handle() { close(session); }
  Session& open() {
    if (!session) throw py::value_error("the Compositor is closed");
    return *session;
  }
};

}  // namespace
}  // namespace pellucid::python

PYBIND11_MODULE(_pellucid, module) {
  using namespace pellucid;
  using namespace pellucid::python;
  module.doc() = "The native half of pellucid.";
  module.attr("__version__") = PELLUCID_VERSION;
  addErrors(module);
  py::class_<MemoryPicture, std::shared_ptr<MemoryPicture>>(module, "Picture")
      .def(py::init(&pictureOf))
      .def_property_readonly("colour", &colourOf)
      .def_property_readonly("depth", &depthOf);
  py::class_<Camera>(module, "Camera");
  module.def("camera", &python::cameraOf);
  module.def("options", &optionsOf);
  module.def("nearest", &nearest);
  py::class_<Handle>(module, "Session")
      .def(py::init([](const Words& words, std::shared_ptr<MemoryPicture> picture, std::optional<Camera> camera) {
        auto handle = std::make_unique<Handle>();
        handle->session = opened(words, std::move(picture), std::move(camera));
        return handle;
      }))
      .def("run", [](Handle& handle, const Words& words) { return run(handle.open(), words); })
      .def("plan", [](Handle& handle, const Words& words) { return plan(handle.open(), words); })
      .def("addresses", [](Handle& handle) { return handle.open().addresses(); })
      .def("loads", [](Handle& handle) { return handle.open().loads(); })
      .def("close", [](Handle& handle) { close(handle.session); });
  module.def("accumulate", &python::accumulate);
  module.def("resolve", &python::resolve);
  module.def("flatten", &python::flatten);
  module.def("compare", &python::compare);
  module.def("study", &python::study);
}
