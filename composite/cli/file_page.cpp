#include "composite/cli/file_page.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "composite/cli/scene_look.h"
#include "composite/look/inspect_page.h"
#include "gbuffer/errors.h"
#include "gbuffer/inspect.h"

namespace pellucid::cli {
namespace {

Page pageWithScene(const std::string& file, const std::string& text, const ReadOptions& read,
                   const std::vector<std::string>& scenes, const CameraChoice& camera, const PageDisplayFlags& shown) {
  try {
    ScenePreview preview = previewOf(file, scenes, read, camera);
    const SceneLook look = lookAt(preview);
    const Shot& shot = preview.compositor->shot();
    const std::optional<Camera> seenBy = shot.hasCamera ? std::optional(shot.camera) : std::nullopt;
    return inspectPage(shot.opaque.document, text, UnderstoodShot{&shot.opaque, seenBy}, look,
                       shown.shaderOf(shot.opaque.document));
  } catch (const Error& error) {
    // Its sentences name flags of that verb.
    throw Error(error.exitCode(), std::string("composite says: ") + error.what());
  }
}

}  // namespace

void writeFilePage(const std::string& page, const std::string& file, const nlohmann::json& report,
                   const ReadOptions& read, const std::vector<std::string>& scenes, const CameraChoice& camera,
                   const PageDisplayFlags& shown) {
  const std::string text = inspectionText(report);
  const auto write = [&](Page made) {
    made.exposure = shown.exposure;
    writePage(page, made);
  };
  if (!scenes.empty()) return write(pageWithScene(file, text, read, scenes, camera, shown));
  if (report.contains("refusal")) {  // no picture with a depth: its channels all the same
    const ExrDocument document = readExr(file);
    return write(inspectPage(document, text, std::nullopt, std::nullopt, shown.shaderOf(document)));
  }
  std::unique_ptr<DeepOpaque> deep;
  const OpaqueFile opaque = readPictureFile(file, read, nullptr, deep);
  write(inspectPage(opaque.document, text, UnderstoodShot{&opaque, opaque.gbuffer.camera}, std::nullopt,
                    shown.shaderOf(opaque.document)));
}

}  // namespace pellucid::cli
