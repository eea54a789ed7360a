#include "composite/colour/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "composite/colour/library.h"
#include "composite/colour/neighbours.h"
#include "gbuffer/errors.h"

namespace pellucid {

std::string oneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = static_cast<unsigned char>(c) <= ' ';
    if (!blank || (!line.empty() && line.back() != ' ')) line += blank ? ' ' : c;
  }
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

ocio::MatrixTransformRcPtr matrixTransform(const glm::dmat3& matrix) {
  double rows[16] = {};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rows[4 * r + c] = matrix[c][r];
  rows[15] = 1.0;
  ocio::MatrixTransformRcPtr transform = ocio::MatrixTransform::Create();
  transform->setMatrix(rows);
  return transform;
}

namespace {

// One of namedSpaces(), to the reference, which is ACES2065-1.
ocio::ColorSpaceRcPtr colourSpaceOf(const NamedSpace& row) {
  ocio::ColorSpaceRcPtr space = ocio::ColorSpace::Create();
  space->setName(row.name);
  for (const char* alias : row.aliases) space->addAlias(alias);
  space->setBitDepth(ocio::BIT_DEPTH_F32);
  const NamedSpace& aces = *namedSpace("ACES2065-1");
  if (&row == &aces) return space;
  const glm::dmat3 toAces = *fromRec709(aces.chromaticities) * glm::inverse(*fromRec709(row.chromaticities));
  space->setTransform(matrixTransform(toAces), ocio::COLORSPACE_DIR_TO_REFERENCE);
  return space;
}

ocio::BuiltinTransformRcPtr builtIn(const char* style) {
  ocio::BuiltinTransformRcPtr transform = ocio::BuiltinTransform::Create();
  transform->setStyle(style);
  return transform;
}

// From the reference to CIE XYZ under D65, which displays start from.
void addView(ocio::Config& config, const char* name, const char* style) {
  ocio::ViewTransformRcPtr transform = ocio::ViewTransform::Create(ocio::REFERENCE_SPACE_SCENE);
  transform->setName(name);
  transform->setTransform(builtIn(style), ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE);
  config.addViewTransform(transform);
}

void addDisplay(ocio::Config& config) {
  ocio::ColorSpaceRcPtr display = ocio::ColorSpace::Create(ocio::REFERENCE_SPACE_DISPLAY);
  display->setName("sRGB - Display");
  display->setTransform(builtIn("DISPLAY - CIE-XYZ-D65_to_sRGB"), ocio::COLORSPACE_DIR_FROM_REFERENCE);
  config.addColorSpace(display);
  ocio::ColorSpaceRcPtr raw = ocio::ColorSpace::Create();
  raw->setName("raw");
  raw->setIsData(true);
  config.addColorSpace(raw);
  addView(config, "as it is", "UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD");
  addView(config, "ACES 1.0 SDR video", "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0");
  config.addDisplayView("sRGB", "sRGB", "as it is", "sRGB - Display", "", "", "");
  config.addDisplayView("sRGB", "ACES SDR", "ACES 1.0 SDR video", "sRGB - Display", "", "", "");
  config.addDisplayView("sRGB", "raw", "raw", "");
}

// The product of a processor's steps where all of them are matrices without offsets.
std::optional<glm::dmat3> productOf(const ocio::ConstProcessorRcPtr& processor) {
  const ocio::GroupTransformRcPtr steps = processor->createGroupTransform();
  glm::dmat3 product(1.0);
  for (int i = 0; i < steps->getNumTransforms(); ++i) {
    const auto step = OCIO_DYNAMIC_POINTER_CAST<ocio::MatrixTransform>(steps->getTransform(i));
    if (!step) return std::nullopt;
    double rows[16], offset[4];
    step->getMatrix(rows);
    step->getOffset(offset);
    glm::dmat3 matrix(0.0);
    for (int r = 0; r < 3; ++r) {
      if (offset[r] != 0.0 || rows[4 * r + 3] != 0.0) return std::nullopt;
      for (int c = 0; c < 3; ++c) matrix[c][r] = rows[4 * r + c];
    }
    product = (step->getDirection() == ocio::TRANSFORM_DIR_INVERSE ? glm::inverse(matrix) : matrix) * product;
  }
  return product;
}

// A matrix that a processor of other steps comes to, asked at points over six decades; nothing where it is none.
std::optional<glm::dmat3> measuredMatrix(const ocio::ConstProcessorRcPtr& processor) {
  constexpr float kSlack = 1e-4f;  // of steps in float: curves and tables
  const ocio::ConstCPUProcessorRcPtr cpu = processor->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
  const auto at = [&](glm::vec3 colour) {
    cpu->applyRGB(&colour.x);
    return colour;
  };
  const glm::mat3 matrix(at({1, 0, 0}), at({0, 1, 0}), at({0, 0, 1}));
  for (const float scale : {1e-3f, 0.02f, 0.18f, 1.0f, 30.0f, 1e3f})
    for (const glm::vec3& colour : {glm::vec3(1, 1, 1), glm::vec3(1, 0.5f, 0.25f), glm::vec3(0.1f, 0.9f, 0.4f)}) {
      const glm::vec3 found = at(scale * colour), expected = matrix * (scale * colour);
      const glm::vec3 off = glm::abs(found - expected);
      if (!(std::max({off.x, off.y, off.z}) <= kSlack * scale)) return std::nullopt;
    }
  return glm::dmat3(matrix);
}

bool keepsWhite(const glm::dmat3& matrix) {
  const glm::dvec3 white = matrix * glm::dvec3(1.0);
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(white[c] - 1.0) < 1e-3)) return false;
  return true;
}

// Rows that sum to 1 exactly, which tables and programs' rounded constants only nearly do.
glm::dmat3 withWhite(glm::dmat3 matrix) {
  const glm::dvec3 white = matrix * glm::dvec3(1.0);
  for (int c = 0; c < 3; ++c) matrix[c] /= white;
  return matrix;
}

std::string namesOf(const ocio::Config& config) {
  constexpr int kMost = 40;
  std::string names;
  const int count = config.getNumColorSpaces();
  for (int i = 0; i < std::min(count, kMost); ++i)
    names += (names.empty() ? "" : ", ") + std::string(config.getColorSpaceNameByIndex(i));
  return count > kMost ? fmt::format("{} and {} more", names, count - kMost) : names;
}

}  // namespace

ocio::ConstConfigRcPtr builtInConfig() {
  ocio::ConfigRcPtr config = ocio::Config::Create();
  config->setVersion(2, 1);
  for (const NamedSpace& row : namedSpaces()) config->addColorSpace(colourSpaceOf(row));
  config->setRole("aces_interchange", "ACES2065-1");
  config->setRole(ocio::ROLE_SCENE_LINEAR, namedSpaces()[0].name);
  config->setRole(ocio::ROLE_DEFAULT, namedSpaces()[0].name);
  addDisplay(*config);
  return config;
}

KnownSpace ColourConfig::Impl::known() const {
  if (config->hasRole("aces_interchange"))
    return {config->getColorSpace("aces_interchange")->getName(),
            *fromRec709(namedSpace("ACES2065-1")->chromaticities)};
  for (const NamedSpace& row : namedSpaces()) {
    std::vector<const char*> names = row.aliases;
    names.push_back(row.name);
    for (const char* name : names)
      if (config->getColorSpace(name)) return {name, *fromRec709(row.chromaticities)};
  }
  throw MeaningError(
      fmt::format("{}: found neither the role aces_interchange nor a linear space of a known name ({}), expected one: "
                  "it tells the primaries of the others",
                  title(), spaceNames()));
}

std::optional<ColourSpace> ColourConfig::Impl::find(const ocio::ConstColorSpaceRcPtr& space) const {
  if (space->isData()) return std::nullopt;
  try {
    const KnownSpace from = known();
    const ocio::ConstProcessorRcPtr processor = config->getProcessor(from.name.c_str(), space->getName());
    std::optional<glm::dmat3> matrix = productOf(processor);
    if (!matrix) matrix = measuredMatrix(processor);
    if (!matrix || !(std::abs(glm::determinant(*matrix)) > 1e-9)) return std::nullopt;
    *matrix = *matrix * from.fromRec709;
    if (!keepsWhite(*matrix)) return std::nullopt;
    ColourSpace found = spaceBy(space->getName(), withWhite(*matrix));
    // One of ours keeps its exact numbers.
    for (const NamedSpace& row : namedSpaces()) {
      const ColourSpace ours = *pellucid::spaceOf(row.chromaticities);
      if (!sameSpace(ours, found)) continue;
      found.fromRec709 = ours.fromRec709;
      found.chromaticities = ours.chromaticities;
    }
    return found;
  } catch (const ocio::Exception& error) {
    throw InputError(fmt::format("{}: colour space {}: {}", title(), space->getName(), oneLine(error.what())));
  }
}

ColourConfig::ColourConfig(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ColourConfig::~ColourConfig() = default;
ColourConfig::ColourConfig(ColourConfig&&) noexcept = default;
ColourConfig& ColourConfig::operator=(ColourConfig&&) noexcept = default;

ColourConfig ColourConfig::builtIn() {
  auto impl = std::make_unique<Impl>();
  impl->config = builtInConfig();
  return ColourConfig(std::move(impl));
}

ColourConfig ColourConfig::read(const std::string& path, const std::string& by, const std::string& assetRoot) {
  ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);  // what there is to say, exceptions say
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  try {
    impl->config = ocio::Config::CreateFromFile(path.c_str());
    impl->config->validate();
  } catch (const ocio::Exception& error) {
    throw InputError(
        fmt::format("{}: {}: found no valid OpenColorIO config, expected one: {}", path, by, oneLine(error.what())));
  }
  expectNeighbours(*impl->config, path, assetRoot);
  return ColourConfig(std::move(impl));
}

ColourSpace ColourConfig::space(const std::string& name) const {
  const ocio::ConstColorSpaceRcPtr found = impl_->config->getColorSpace(name.c_str());
  if (!found)
    throw UsageError(fmt::format("--working-space: found '{}', expected auto or a colour space of {}: {}", name,
                                 impl_->title(), namesOf(*impl_->config)));
  std::optional<ColourSpace> space = impl_->find(found);
  if (!space)
    throw UsageError(
        fmt::format("--working-space: found '{}', expected a linear RGB space of {}: light adds up in no "
                    "other",
                    name, impl_->title()));
  space->source = SpaceSource::flag;
  return *space;
}

std::optional<ColourSpace> ColourConfig::spaceOfFile(const std::string& file) const {
  const ocio::Config& config = *impl_->config;
  const ocio::ConstColorSpaceRcPtr found = config.getColorSpace(config.getColorSpaceFromFilepath(file.c_str()));
  std::optional<ColourSpace> space = found ? impl_->find(found) : std::nullopt;
  if (space)
    space->source =
        config.filepathOnlyMatchesDefaultRule(file.c_str()) ? SpaceSource::defaultRule : SpaceSource::fileRule;
  return space;
}

}  // namespace pellucid
