// OIT planes as an EXR file: layer `oit`, float, with a `pellucid:` header that says how the sums were made.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/accum.h"
#include "gbuffer/pixel_filter.h"
#include "gbuffer/rim_planes.h"

namespace pellucid {

// Every bit of the planes, of `info` and of the camera comes back from readPlanes. Throws ResourceError.
//   rims  channels oit.rim.*, unless empty
void writePlanes(const std::string& path, const OitPlanes& planes, const RimPlanes& rims = {});
// Throws InputError for a damaged file or a sum that is not finite, MeaningError for one without the planes or the
// header.
//   rims  is given those of the file; a file that has some must not be read without
OitPlanes readPlanes(const std::string& path, RimPlanes* rims = nullptr);

// One jittered pass of several, and what rims get from around where that is kept apart.
struct PassPlanes {
  OitPlanes planes;
  OitPlanes
      scatter;  // of a deep picture, where layers look it up elsewhere: of its pixels, as planes are of its places
  RimPlanes rims;
  // Of the first pass alone: the beauty as the layers' shadows leave it, and 1 where they changed it. Empty: nowhere.
  Image<glm::vec4> relit;
  // Of the first pass alone: the layer `shadow` of the picture, which nothing there has taken in. Empty: none.
  Image<glm::vec3> shadow;
  // Where shadows move with the passes: the beauty as it is lit in this one, without its alpha. Empty: as above.
  Image<glm::vec4> now;
  // Of the first pass alone: the camera that took the picture, where passes have their own times or points of the lens.
  std::optional<Camera> pictureCamera;
  PixelFilter pixelFilter;  // that the passes' places were drawn from
  bool edges = false;       // at filtered edges of the picture each pass sees one of the two surfaces
};
// A part for each pass, in order, and one more after it where it has `scatter`; a single one as writePlanes() does it.
//   attributes  of the first part's header, besides those of planes
void writePasses(const std::string& path, const std::vector<PassPlanes>& passes,
                 const std::map<std::string, std::string>& attributes = {});
// Throws what readPlanes() throws, and MeaningError for parts that are not all the passes of one picture.
std::vector<PassPlanes> readPasses(const std::string& path);

}  // namespace pellucid
