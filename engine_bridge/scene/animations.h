// The animations of a glTF file that are played: channels, and what they move.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine_bridge/scene/curve.h"
#include "engine_bridge/scene/gltf_file.h"

namespace pellucid::gltf {

// What a channel moves: a property of the document, by its place in it ("/nodes/3/translation").
struct Moved {
  std::string pointer;
  CurveShape shape;
};

// Nothing for a channel whose target is undefined, or is nothing that a picture shows, which is noted.
// Throws InputError: a node or a property that is not there, an animated node with a matrix, an unknown path.
//   target  animations[i].channels[j].target
std::optional<Moved> movedBy(const GltfFile& file, const JsonView& target, Notes& notes);

// One file's animations, of which some are played. Posing writes the values of a time into the file's document, whose
// reader then finds nothing but a file that stands like that.
class Animations {
 public:
  //   wanted  names, or "all"; empty: all where no two move the same, else the first. A name is played wherever it is
  //           found; one that a file lacks is not played there
  // Throws InputError for what the samplers and channels refuse.
  Animations(GltfFile& file, const std::vector<std::string>& wanted, Notes& notes);
  bool any() const { return !channels_.empty(); }
  // Of the animations that are there, in file order; "animation 3" for one without a name.
  const std::vector<std::string>& names() const { return names_; }
  // What is played, and over which seconds, for messages.
  std::string description() const;
  double firstSecond() const { return first_; }
  double lastSecond() const { return last_; }
  // Throws InputError for a value that its property cannot take.
  void pose(double seconds);

 private:
  struct Channel {
    std::string pointer;
    std::shared_ptr<const Curve> curve;
  };
  struct Played {
    std::string name;
    std::vector<Channel> channels;
  };
  Played read(const JsonView& animation, const std::string& name, Notes& notes);
  std::shared_ptr<const Curve> curveOf(const JsonView& sampler, const CurveShape& shape);

  GltfFile* file_;
  std::vector<std::string> names_, played_;
  std::vector<Channel> channels_;                               // one for each property
  std::map<std::string, std::shared_ptr<const Curve>> curves_;  // by what readCurve() was asked for
  std::size_t charged_ = 0;                                     // numbers held by curves_
  double first_ = 0.0, last_ = 0.0;
};

}  // namespace pellucid::gltf
