// Images of a glTF file through OpenImageIO, decoded once for each use that differs.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "engine_bridge/scene/gltf_file.h"
#include "engine_bridge/scene/scene.h"

namespace pellucid::gltf {

enum class TexelUse {
  colour,  // sRGB to linear, except for images of floating-point type, which are linear as stored
  data,    // as stored, 0 to 1
};

// Decodes PNG, JPEG and whatever else OpenImageIO reads from memory, alpha left straight.
//   whose   begins an error's sentence: "scene.gltf: material glass: image wood.png"
//   name    its extension tells the format where the content has no signature
//   fromRec709  is given the space that a floating-point colour image states; may be null
// Throws InputError; texels that are not finite become 0 and are noted.
Image<glm::vec4> decodeImage(const std::vector<std::uint8_t>& bytes, TexelUse use, const std::string& whose,
                             const std::string& name, Notes& notes, glm::dmat3* fromRec709 = nullptr);

// False when a PNG or JPEG ends before its last marker. Other formats' readers notice themselves.
//   format  "png", "jpg" or another extension, by the content's signature
bool isWholeImage(const std::vector<std::uint8_t>& bytes, const std::string& format);

// The same WebP with its alpha marked as unused; empty where nothing says that it is used.
std::optional<std::vector<std::uint8_t>> withoutWebpAlpha(const std::vector<std::uint8_t>& bytes);

// sRGB to linear, IEC 61966-2-1, evaluated in double. Values outside [0, 1] are clamped.
float linearFromSrgb(float encoded);

class TextureReader {
 public:
  TextureReader(GltfFile& file, std::vector<Texture>& textures, Notes& notes)
      : file_(&file), textures_(&textures), notes_(&notes) {}

  // The texture that a textureInfo object points at, as an index into the scene's textures; added at first use.
  // Throws InputError naming the material and the image.
  //   decode  false leaves the image unread, for materials that nothing draws; the result's texture is then -1
  TextureRef read(const JsonView& textureInfo, TexelUse use, const std::string& material, bool decode);
  // The roughness, in the green channel, of a texture whose alpha times `glossiness` is glossy.
  TextureRef readGlossy(const JsonView& textureInfo, float glossiness, const std::string& material, bool decode);

 private:
  TextureRef place(const JsonView& textureInfo, const std::string& material, bool decode) const;
  //   glossiness  below 0 for texels as they are
  int load(const JsonView& texture, TexelUse use, float glossiness, const std::string& material);
  Texture open(std::size_t image, TexelUse use, const std::string& material);

  GltfFile* file_;
  std::vector<Texture>* textures_;
  Notes* notes_;
  // By image, use, sampling and glossiness (below 0: none).
  std::map<std::tuple<std::size_t, TexelUse, Sampling, float>, int> loaded_;
  std::size_t texels_ = 0;
};

}  // namespace pellucid::gltf
