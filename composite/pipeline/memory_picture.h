// An opaque picture that the caller holds in memory, composited onto without a copy of its colours and depths: shots
// show the caller's own pixels, any number of shots at once. Planes are as a GBuffer has them, but for normals of any
// length and occlusion of any value. Where a field is of no use in memory, as the precision of depth, it is not read.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid {

// The name by which messages call it.
inline constexpr const char* kMemoryPicture = "picture in memory";

// Depths in memory are planar metres below this; +inf says that nothing was hit. What files say beyond it, they say of
// nothing.
constexpr float kFarthestInMemory = 1e9f;

// Where the request has such a picture: throws UsageError for planes of different sizes, and for flags that say how a
// file is read. Nothing otherwise.
void checkMemoryPicture(const ShotRequest& request);

// Fills what readers fill. Beauty and depth are the caller's own pixels, and keep the picture alive; normals are
// copied, and brought to unit length; occlusion to [0,1]. The picture has passed the check. Throws UsageError for a
// depth that is neither positive metres nor +inf.
void readMemoryPicture(const std::shared_ptr<const GBuffer>& picture, OpaqueFile& file);

// A file of such a picture with another beauty: R, G, B, A where it has one, Z, normals, occlusion, and the layers.
// Returns the notes. Throws ResourceError.
//   camera   null where nothing needed one
//   samples  N, where beauty and layers are means of N x N pixels of the picture
std::vector<std::string> writeFromMemory(const std::string& path, const OpaqueFile& opaque, const Camera* camera,
                                         const Image<glm::vec4>& beauty, const std::vector<ExtraLayer>& layers,
                                         const std::map<std::string, std::string>& attributes, int samples = 1);

}  // namespace pellucid
