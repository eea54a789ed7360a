// Linear colour spaces, each by its primaries and white, and the one that a picture is in.
#pragma once
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/exr_document.h"

namespace pellucid {

// CIE 1931 x, y, as EXR's attribute of that name has them.
struct Chromaticities {
  glm::dvec2 red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06}, white{0.3127, 0.3290};  // Rec.709
};

// A space that is known without a config.
struct NamedSpace {
  const char* name;                  // as OpenColorIO's configs for CG call it
  std::vector<const char*> aliases;  // what else calls it so; capitals do not count
  Chromaticities chromaticities;
};
const std::vector<NamedSpace>& namedSpaces();
const NamedSpace* namedSpace(const std::string& name);  // null for an unknown one
std::string spaceNames();                               // "Linear Rec.709 (sRGB), ACEScg, ..."
std::string spacesHelp();                               // a line for every row

// How a picture's space was found.
enum class SpaceSource { nothing, preset, defaultRule, fileRule, chromaticities, flag };

// The space in which a picture's colours are, and so all arithmetic.
struct ColourSpace {
  std::string name = "Linear Rec.709 (sRGB)";
  SpaceSource source = SpaceSource::nothing;
  // Linear Rec.709 to this space, white to white. Exactly 1 for Rec.709, so that no bit changes.
  glm::dmat3 fromRec709{1.0};
  Chromaticities chromaticities;

  bool isRec709() const { return fromRec709 == glm::dmat3(1.0); }
};

// White adapted by Bradford's matrix. Nothing where primaries and white span no colours.
std::optional<glm::dmat3> fromRec709(const Chromaticities& space);
// The space of these primaries: one of the named ones where they are that near. Nothing as above.
std::optional<ColourSpace> spaceOf(const Chromaticities& primaries);
// A space by the matrix alone: its chromaticities are those under the white of Rec.709.
ColourSpace spaceBy(const std::string& name, const glm::dmat3& fromRec709);

// As EXR's attribute has them: 8 numbers, red first.
std::vector<float> numbersOf(const Chromaticities& space);
// The numbers to write for a space: none for Rec.709 that no attribute states, so that such a file stays as it was.
std::vector<float> chromaticitiesToWrite(const ColourSpace& space);

// What the attribute `chromaticities` says; nothing where there is none of that type.
std::optional<Chromaticities> chromaticitiesOf(const ExrPart& part);
// What a file says of itself: by chromaticities, else by its producer's preset, else nothing.
//   preset  a name of namedSpaces(), or ""
//   notes   is told of chromaticities that are none
ColourSpace statedSpace(const ExrPart& part, const std::string& preset, std::vector<std::string>& notes);

// "Linear Rec.709 (sRGB), as nothing says otherwise"; "ACEScg by chromaticities"
std::string spaceText(const ColourSpace& space);
// "chromaticities"; "nothing"
const char* nameOf(SpaceSource source);

bool sameSpace(const ColourSpace& a, const ColourSpace& b);

// The space as string attributes, and back; linear Rec.709 where there are none. Throws MeaningError for others.
void putSpace(const ColourSpace& space, std::map<std::string, std::string>& attributes);
ColourSpace readSpace(const ExrPart& part, const std::string& path);

// A colour under the matrix, in double. Greys keep their bits; what would be negative is 0.
glm::vec3 converted(const glm::dmat3& matrix, const glm::vec3& colour);

}  // namespace pellucid
