#include "composite/cli/file_page.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "composite/cli/scene_look.h"
#include "composite/look/inspect_page.h"
#include "gbuffer/inspect.h"

namespace pellucid::cli {

void writeFilePage(const std::string& page, const std::string& file, const nlohmann::json& report,
                   const ReadOptions& read, const std::vector<std::string>& scenes, const CameraChoice& camera) {
  const std::string text = inspectionText(report);
  if (!scenes.empty()) {
    ScenePreview preview = previewOf(file, scenes, read, camera);
    const SceneLook look = lookAt(preview);
    const Shot& shot = preview.compositor->shot();
    writePage(page, inspectPage(shot.opaque.document, text, UnderstoodShot{&shot.opaque, shot.camera}, look));
    return;
  }
  if (report.contains("refusal")) {  // no picture with a depth: its channels all the same
    writePage(page, inspectPage(readExr(file), text, std::nullopt, std::nullopt));
    return;
  }
  std::unique_ptr<DeepOpaque> deep;
  const OpaqueFile opaque = readPictureFile(file, read, nullptr, deep);
  writePage(page, inspectPage(opaque.document, text, UnderstoodShot{&opaque, opaque.gbuffer.camera}, std::nullopt));
}

}  // namespace pellucid::cli
