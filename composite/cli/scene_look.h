// What a scene does to a picture, for the page of `inspect --html`.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "composite/look/inspect_page.h"
#include "composite/pipeline/compositor.h"

namespace pellucid::cli {

// The compositor of one pass over the picture, with the notes that `composite` would give.
struct ScenePreview {
  std::shared_ptr<std::vector<std::string>> notes;
  std::unique_ptr<Compositor> compositor;
  Request request;
};
// Throws what Compositor throws.
ScenePreview previewOf(const std::string& opaque, const std::vector<std::string>& scenes, const ReadOptions& read,
                       const CameraChoice& camera);

// Composites at pixel centres. Throws what Compositor::run throws.
SceneLook lookAt(ScenePreview& preview);

}  // namespace pellucid::cli
