// glTF 2.0 and GLB files to a Scene.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine_bridge/scene/scene.h"

namespace pellucid {

// Which materials' textures are read. What is drawn of a file may do without those of the others, which may then be
// missing or in a format that is not read.
enum class Textured { all, transparent, opaque };

struct SceneOptions {
  double metresPerUnit = 1.0;          // --unit
  double lumensPerWatt = 683.0;        // --lumens-per-watt: glTF lights are photometric, renders are not
  std::vector<std::string> overrides;  // --set MATERIAL.key=value
  // --thin auto: where a file's exporter writes no volumes, closed meshes of glass are solid. closed_glass.h
  bool closedGlass = false;
  Textured textured = Textured::all;
  std::string assetRoot;  // --asset-root: files may lie here besides under their scene's folder
  // Not 0: triangles stay in their files until they are drawn, which only the transparent GL pass can do, and about so
  // many bytes of the files are in memory at once.
  std::size_t streamBytes = 0;
  // Of the files' animations, which are then played; nothing leaves everything as the files store it.
  std::optional<double> seconds;
  std::string secondsBy;                // what says so, for a message: "41.75 s, frame 1002 (--frame)"
  std::vector<std::string> animations;  // names, or "all"; empty: see Animations in animations.h
  bool operator==(const SceneOptions&) const = default;
};

// Appends the files' contents in the order given. Throws InputError (missing file, missing texture, damaged buffer),
// MeaningError (a required extension we do not know, by name), UsageError (--set names no material or key).
Scene loadScene(const std::vector<std::string>& paths, const SceneOptions& options);

// The same, of files that stay open as long as they have more to give: a scene that moves.
class SceneFiles {
 public:
  // Loads them at options.seconds, as loadScene() does.
  //   scene  empty; must outlive this, at the same place
  SceneFiles(const std::vector<std::string>& paths, const SceneOptions& options, Scene& scene);
  ~SceneFiles();
  SceneFiles(const SceneFiles&) = delete;
  SceneFiles& operator=(const SceneFiles&) = delete;

  // Whether an animation is played; if not, nothing can be posed.
  bool moves() const;
  // Poses the scene anew, as it would have been loaded at that time. Textures, and primitives that no skin and no
  // morph target moves, stay what they are, in the colour space that bringInto() has brought them into; everything else
  // is read again, and waits for bringInto(). Throws what loadScene() throws.
  // Returns the primitives that it has read again.
  std::vector<int> pose(double seconds);
  // The same for another picture: the notes of the scene say so.
  //   secondsBy  as SceneOptions has it
  std::vector<int> pose(double seconds, const std::string& secondsBy);

 private:
  struct File;
  void expectNames() const;

  SceneOptions options_;
  Scene& scene_;
  std::vector<std::unique_ptr<File>> files_;
};

}  // namespace pellucid
