// A shot's layers split into coarsely sorted systems: WB13 section 3.4. A system is an input file or a named node.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "composite/pipeline/device.h"
#include "composite/pipeline/shot.h"

namespace pellucid {

struct LayerSystem {
  std::string name;  // of the file or node
  double z = 0;      // planar metres to the middle of its bounding box, or of a deep file's samples
  Scene scene;       // of triangles: geometry and textures are copied
  std::unique_ptr<TransparentPass> pass;              // null for a deep file
  const std::unique_ptr<DeepSource>* deep = nullptr;  // of the shot; null for triangles
};

// Farthest first. Deep files are systems of their own under both rules.
std::vector<LayerSystem> splitSystems(SystemRule rule, const Shot& shot, Device& device, Journal& journal);

}  // namespace pellucid
