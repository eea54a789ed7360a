// An opaque picture that the caller holds in memory, composited onto without a copy of its colours and depths.
#pragma once
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid {

// The planes of such a picture, which shots borrow. Where they lie never changes, whoever has them.
class MemoryPicture {
 public:
  // Beauty and viewZ of one size; normals and occlusion of that size, or empty.
  explicit MemoryPicture(GBuffer planes);
  // The beauty and depth to render into while nobody composites onto them, float32, row by row.
  glm::vec4* beauty() { return beauty_; }
  float* viewZ() { return viewZ_; }
  int width() const { return width_; }
  int height() const { return height_; }

  // Throws UsageError for planes of different sizes, and for a depth that is neither positive metres nor +inf.
  void check() const;
  // The planes as records have them: normals of unit length, occlusion in [0,1]. The first who borrows has beauty and
  // depth where they lie, others at the same time have a copy of them.
  //   to  where they will stand until they are given back
  void lend(GBuffer& to);
  // Those of a shot that ends. Nothing for planes that were copied.
  void takeBack(GBuffer& from);

 private:
  const GBuffer& held() const { return holder_ ? *holder_ : planes_; }
  mutable std::mutex mutex_;
  GBuffer planes_;  // beauty and viewZ are empty while they are lent
  GBuffer* holder_ = nullptr;
  glm::vec4* beauty_;
  float* viewZ_;
  int width_, height_;
};

// The name by which messages call it.
inline constexpr const char* kMemoryPicture = "picture in memory";

// Depths in memory are planar metres below this; +inf says that nothing was hit. What files say beyond it, they say of
// nothing.
constexpr float kFarthestInMemory = 1e9f;

// Where the request has such a picture: throws what check() throws, and UsageError for flags that say how a file is
// read. Nothing otherwise.
void checkMemoryPicture(const ShotRequest& request);

// Fills what readers fill. The picture has passed the check; beauty and depth are borrowed.
void readMemoryPicture(MemoryPicture& picture, OpaqueFile& file);

// A file of such a picture with another beauty: R, G, B, A where it has one, Z, normals, occlusion, and the layers.
// Returns the notes. Throws ResourceError.
//   camera   null where nothing needed one
//   samples  N, where beauty and layers are means of N x N pixels of the picture
std::vector<std::string> writeFromMemory(const std::string& path, const OpaqueFile& opaque, const Camera* camera,
                                         const Image<glm::vec4>& beauty, const std::vector<ExtraLayer>& layers,
                                         const std::map<std::string, std::string>& attributes, int samples = 1);

}  // namespace pellucid
