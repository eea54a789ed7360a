// What a pixel of a composited picture may be, by the reference: the right value and how far off it sampling may lead,
// derived for each pixel from what lies in it.
#pragma once
#include <array>
#include <functional>
#include <map>
#include <vector>

#include "gbuffer/image.h"
#include "tests/pictures/drawn_flags.h"

namespace pellucid::test {

// How a pixel is judged, by what is opaque under its filter.
enum class Judged {
  inner,     // one face: what the passes' own rays see, but for roundings of place and depth
  filtered,  // of these, that the passes stand for the filter: 3 standard errors of as many places
  edge,      // two faces whose colours the picture tells apart: their veils may be mixed by nothing but their shares
  mixed,     // whatever else: any mixture of what is seen under the filter
  count
};
struct Statement {
  Judged judged = Judged::inner;
  reference::Vec4 right{0.0}, allowed{0.0};  // R, G, B, A
  reference::Vec4 variance{0.0};             // among the passes
  // The largest error as a part of what is allowed.
  double error(const reference::Vec4& value) const;
};

class Statements {
 public:
  //   beauty  the picture as the file holds it
  //   places  where the passes sample the pixel, (0..1, y down), the pixel's square; beyond it for wide filters
  Statements(const DrawnScene& scene, const reference::Picture& picture, const reference::Samples& samples,
             const DrawnFlags& flags, const Image<glm::vec4>& beauty, std::vector<glm::dvec2> places);
  // One, or two for pixels of which the filtered mean is stated as well; none where the reference cannot say.
  std::vector<Statement> of(int x, int y) const;

 private:
  struct Range {
    reference::Vec4 low{1e300}, high{-1e300};
    void take(const reference::Vec4& value);
    void take(const Range& other);
  };
  // A pixel, and where a pass or a place of the reference lies in it.
  struct Spot {
    int x, y;
    reference::Vec2 place;
  };
  // What a pixel of the backdrop may hold in a pass.
  struct Texel {
    reference::Vec4 colour;
    double z;
    bool operator==(const Texel&) const = default;
  };
  struct Surroundings {
    std::vector<reference::Face> faces;  // under the filter
    bool onPlane = true;                 // the pixels beside it tell the slope of its face
    double beside = 0.0;                 // relative: how far another face beside it may lead its slope astray
  };
  void takeSolids();
  Surroundings surroundingsOf(int x, int y) const;
  reference::Vec4 valueOf(const reference::Shown& shown, const reference::Vec4& behind) const;
  // What is seen behind the layers: by straight rays `behind`, by bent ones what the picture shows elsewhere.
  //   first, last  between which the opaque depth lies
  Range seenBehind(const Spot& spot, const reference::Shown& shown, const reference::Vec4& behind, double first,
                   double last) const;
  reference::Vec4 exactlyBehind(const Spot& spot, const reference::Shown& shown, const reference::Vec4& behind,
                                double z) const;
  // Between the four pixels around a position, but for those that stand in front of the layer. What is straight behind
  // the layers never does.
  Range lookedUp(const Spot& spot, const reference::Vec2& position, const reference::Vec4& behind, double layerZ,
                 bool exactly) const;
  void takeFarther(int x, int y, double limit, Range& range) const;
  std::vector<Texel> texelsAt(int x, int y, const reference::Vec2& place, bool exactly) const;
  std::vector<Texel> backdropOf(int x, int y, const reference::Column& column, bool exactly) const;
  // Of the pixel and the place of a sample.
  reference::Vec4 sampledValue(int x, int y, const reference::Sampled& sample) const;
  // Of a face that goes on for ever: nothing where it has left the picture, nearer than all where parallel rays meet it
  // behind the eye, as Pellucid has it.
  double faceDepth(const reference::Face& face, const reference::Ray& ray) const;
  double bendOf(int x, int y) const;
  double marginOf(const std::vector<reference::Column>& columns) const;
  // What is shown where the face lies between two depths.
  void eachCut(const reference::Column& column, const reference::Face& face, double nearest, double farthest,
               const std::function<void(const reference::Shown&)>& take) const;
  // All that it may be.
  Range rangeOf(const Spot& spot, const reference::Shown& shown, const reference::Vec4& behind, double first,
                double last) const;
  void takeCuts(const Spot& spot, const reference::Column& column, const reference::Face& face, double nearest,
                double farthest, const reference::Vec4& behind, Range& range) const;
  // Glass at the rim of a mask, which bends by the part that it covers: what one column has and another has not.
  void eachPartly(const reference::Column& more, const reference::Column& fewer,
                  const std::function<void(const reference::Column&)>& take) const;
  Statement innerAt(int x, int y, const Surroundings& around) const;
  Statement filteredAt(int x, int y, const Statement& inner) const;
  Statement mixedAt(int x, int y) const;
  std::optional<Statement> edgeAt(int x, int y, const Surroundings& around) const;
  bool maybeTakenApart(int x, int y) const;
  bool hasCoarseTexels(int x, int y) const;
  bool liesBehind(int x, int y, const reference::Face& own, const reference::Face& other) const;
  bool tellsColour(int x, int y, const reference::Face& face, double& impurity) const;
  const reference::Face& centre(int x, int y) const { return centres_.at(x, y).face; }
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < centres_.width() && y < centres_.height(); }
  reference::Vec4 colourOf(const reference::Face& face) const;

  const reference::Picture& picture_;
  const reference::Samples& samples_;
  const DrawnFlags& flags_;
  const Image<glm::vec4>& beauty_;
  std::vector<glm::dvec2> places_;
  Image<reference::Met> centres_;
  double edge_ = 1.0;       // of the square that a pass stands for, pixels
  double rounding_ = 0.0;   // of positions as floats hold them, metres
  bool striped_ = false;    // the picture has more colours than surfaces
  bool anySolids_ = false;  // of transparent meshes
  Range anywhere_;          // of the picture, and of these
  mutable std::map<std::array<double, 4>, std::vector<Texel>> texels_;
  std::vector<reference::CutBand> bands_;  // rims of masks; none where they are as sharp as a ray
  double size_;
};

}  // namespace pellucid::test
