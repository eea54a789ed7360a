// Particles as a medium: how dense they make the air, for the shadows that they cast on each other and on what is
// there.
#pragma once
#include <memory>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/medium.h"

namespace pellucid {

// 1/m, in cubes as near as whole numbers go, `longest` of them along the longest edge of what the particles fill: the
// mass of a ball of even density, or of a card's, spread over the cubes that it reaches. Points and billboards that
// cast shadows; null without any. The same bits whatever the order of a scene's chunks and threads.
std::shared_ptr<const DensityGrid> particleGrid(const Scene& scene, int longest);

// Texels along the edge of a shadow map in which a particle of mean size is `across` texels wide, a multiple of 128 in
// [512, most]; `most` where anything but particles casts, or where fewer than 16 of them lie over one another on the
// average. A finer map of a dense cloud holds nearly the same shadow for more fragments.
int particleMapSize(const Scene& scene, int across, int most);

// The grid as fog that nobody sees: for gridDepth() and sampleLights().
Fog particleFog(std::shared_ptr<const DensityGrid> grid, const Camera& camera,
                std::vector<shading::PunctualLight> lights);

}  // namespace pellucid
