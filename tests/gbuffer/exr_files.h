// EXR files made and read by plain OpenEXR calls, for tests: a second opinion on what the room under test does.
#pragma once
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPixelType.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "gbuffer/image.h"
#include "tests/support/program.h"

namespace pellucid::test {

namespace exr = OPENEXR_IMF_NAMESPACE;

// A folder that is removed with all it holds.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::vector<std::string> list() const;

 private:
  std::string folder_;
};

struct Plane {
  std::string name;
  exr::PixelType type = exr::HALF;
  std::vector<std::byte> bytes;  // of the data window, row by row
};

struct Part {
  std::string name;
  Window display{0, 0, 8, 6}, data{0, 0, 8, 6};
  exr::Compression compression = exr::ZIP_COMPRESSION;
  exr::LineOrder lineOrder = exr::INCREASING_Y;
  int tileSize = 0;                        // 0: scan lines
  exr::LevelMode levels = exr::ONE_LEVEL;  // of tiles; lower levels are filled too
  std::vector<Plane> planes;
  std::map<std::string, std::string> strings;  // attributes
  std::map<std::string, std::vector<float>> matrices;
  std::string view;
  double pixelAspect = 1.0;
  int environmentMap = -1;  // attribute envmap: 0 lat-long, 1 cube
};

std::size_t pixelsOf(const Window& data);
Plane floatPlane(const std::string& name, const std::vector<float>& values);
Plane halfPlane(const std::string& name, const std::vector<float>& values);
Plane constantPlane(const std::string& name, exr::PixelType type, float value, std::size_t pixels);
// Every bit pattern is as likely as another: NaN payloads, infinities and denormals included.
Plane noisePlane(const std::string& name, exr::PixelType type, std::size_t pixels, unsigned seed);

// One part makes a single-part file, more a multi-part one.
void writeFile(const std::string& path, const std::vector<Part>& parts);

// What a file holds, as bytes.
struct Contents {
  std::map<std::string, std::string> attributes;         // "part/attribute" -> type and bytes
  std::map<std::string, std::vector<std::byte>> planes;  // "part/channel" -> bytes of level 0; deep parts have none
};
Contents readFile(const std::string& path);
void spit(const std::string& path, const std::string& bytes);

}  // namespace pellucid::test
