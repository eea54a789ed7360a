// The studio's boxes and spheres as opaque meshes of the GLB: what casts shadows into fog and smoke.
#pragma once
#include <vector>

#include "samples/generate/glb.h"
#include "samples/generate/studio.h"

namespace pellucid::samples {

// One mesh a shape, its material the albedo at the shape's middle. Cylinders are left out.
void addSolids(Glb& glb, const std::vector<Shape>& shapes);

}  // namespace pellucid::samples
