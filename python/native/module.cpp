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
#include "python/native/veil_planes.h"

namespace py = pybind11;

namespace pellucid::python {
namespace {

py::dict dictOf(Outcome outcome) {
  Result& result = outcome.result;
  const Window& data = result.dataWindow;
  py::dict found;
  found["picture"] = arrayOf(std::move(result.picture.rgba));
  found["touched"] = arrayOf(std::move(result.picture.touched));
  found["veil"] = VeilPlanes(std::move(result.veil), data);
  found["layers"] = arraysOf(std::move(result.layers));
  found["window"] = py::make_tuple(data.x0, data.y0, data.x1, data.y1);
  found["space"] = outcome.space;
  found["plan"] = plainOf(result.plan, outcome.facts);
  found["statistics"] = plainOf(cli::statisticsOf(result.stages, result.counts, result.device));
  const nlohmann::json errors = cli::errorsOf(result);
  found["error"] = errors.contains("error") ? plainOf(errors["error"]) : py::object(py::none());
  found["tolerance"] = errors.contains("tolerance") ? plainOf(errors["tolerance"]) : py::object(py::none());
  found["notes"] = outcome.notes;
  return found;
}

std::shared_ptr<Session> opened(const Words& words, std::shared_ptr<const GBuffer> picture,
                                std::optional<Camera> camera) {
  const py::gil_scoped_release unlocked;
  return std::make_shared<Session>(words, std::move(picture), std::move(camera));
}

py::dict run(Session& session, const Words& words) {
  Outcome outcome;
  {
    const py::gil_scoped_release unlocked;
    outcome = session.run(words);
  }
  return dictOf(std::move(outcome));
}

py::dict plan(Session& session, const Words& words) {
  std::pair<Plan, ShotFacts> found;
  {
    const py::gil_scoped_release unlocked;
    found = session.plan(words);
  }
  return plainOf(found.first, found.second);
}

// Python's handle of a session, which may be closed before it is collected. A call that is under way in another thread
// keeps the session until it ends.
class Handle {
 public:
  explicit Handle(std::shared_ptr<Session> session) : session_(std::move(session)) {}
  ~Handle() { close(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  std::shared_ptr<Session> open() const {
    if (!session_) throw py::value_error("the Compositor is closed");
    return session_;
  }
  // GL contexts and scenes are given back without Python's lock.
  void close() {
    std::shared_ptr<Session> session = std::move(session_);
    const py::gil_scoped_release unlocked;
    session.reset();
  }
  // What a session says of itself; one that is busy is waited for, without the lock.
  template <class Answer>
  Answer ask(Answer (Session::*question)()) const {
    const std::shared_ptr<Session> session = open();
    const py::gil_scoped_release unlocked;
    return (*session.*question)();
  }

 private:
  std::shared_ptr<Session> session_;
};

}  // namespace
}  // namespace pellucid::python

PYBIND11_MODULE(_pellucid, module) {
  using namespace pellucid;
  using namespace pellucid::python;
  module.doc() = "The native half of pellucid.";
  module.attr("__version__") = PELLUCID_VERSION;
  addErrors(module);
  addVeilPlanes(module);
  py::class_<GBuffer, std::shared_ptr<GBuffer>>(module, "Picture")
      .def(py::init([](const Floats& colour, const Floats& depth, bool hasAlpha, const std::optional<Floats>& normals,
                       const std::optional<Floats>& occlusion, std::pair<int, int> origin, std::pair<int, int> display,
                       double pixelAspect) {
        return pictureOf(colour, depth, hasAlpha, normals, occlusion, {origin, display, pixelAspect});
      }));
  py::class_<Camera>(module, "Camera");
  module.def("camera", &python::cameraOf);
  module.def("options", &optionsOf);
  module.def("nearest", &nearest);
  py::class_<Handle>(module, "Session")
      .def(py::init([](const Words& words, std::shared_ptr<GBuffer> picture, std::optional<Camera> camera) {
        return std::make_unique<Handle>(opened(words, std::move(picture), std::move(camera)));
      }))
      .def("run", [](Handle& handle, const Words& words) { return run(*handle.open(), words); })
      .def("plan", [](Handle& handle, const Words& words) { return plan(*handle.open(), words); })
      .def("addresses", [](Handle& handle) { return handle.ask(&Session::addresses); })
      .def("loads", [](Handle& handle) { return handle.ask(&Session::loads); })
      .def("close", &Handle::close);
  module.def("accumulate", &python::accumulate);
  module.def("resolve", &python::resolve);
  module.def("flatten", &python::flatten);
  module.def("compare", &python::compare);
  module.def("study", &python::study);
}
