#include "composite/colour/display.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "composite/colour/library.h"
#include "gbuffer/atomic_file.h"
#include "gbuffer/errors.h"
#include "gbuffer/image_codec.h"

namespace pellucid {
namespace {

std::string refusal(const char* flag, const std::string& found, const ColourConfig::Impl& library,
                    const std::string& names) {
  return fmt::format("{}: found '{}', expected one of {} in {}", flag, found, names.empty() ? "none" : names,
                     library.title());
}

// Whether the view shows numbers as they are.
bool isRaw(const ocio::Config& config, const DisplayChoice& choice) {
  const auto space =
      config.getColorSpace(config.getDisplayViewColorSpaceName(choice.display.c_str(), choice.view.c_str()));
  return space && space->isData();
}

// The choice with the config's own where nothing is said.
DisplayChoice settled(const ColourConfig::Impl& library, DisplayChoice choice) {
  const ocio::Config& config = *library.config;
  std::string displays, views;
  bool found = false;
  if (choice.display.empty()) choice.display = config.getDefaultDisplay();
  for (int i = 0; i < config.getNumDisplays(); ++i) {
    displays += (displays.empty() ? "" : ", ") + std::string(config.getDisplay(i));
    found = found || choice.display == config.getDisplay(i);
  }
  if (!found) throw UsageError(refusal("--display", choice.display, library, displays));
  const char* display = choice.display.c_str();
  if (choice.view.empty()) choice.view = config.getDefaultView(display);
  found = false;
  for (int i = 0; i < config.getNumViews(display); ++i) {
    views += (views.empty() ? "" : ", ") + std::string(config.getView(display, i));
    found = found || choice.view == config.getView(display, i);
  }
  if (!found) throw UsageError(refusal("--view-transform", choice.view, library, views));
  if (choice.look.empty()) return choice;
  std::string looks;
  for (int i = 0; i < config.getNumLooks(); ++i)
    looks += (looks.empty() ? "" : ", ") + std::string(config.getLookNameByIndex(i));
  if (!config.getLook(choice.look.c_str())) throw UsageError(refusal("--look", choice.look, library, looks));
  if (isRaw(config, choice))
    throw UsageError(
        fmt::format("--look: found '{}' with the view {}, expected another view: it shows numbers as they "
                    "are",
                    choice.look, choice.view));
  return choice;
}

ocio::ConstProcessorRcPtr processorFor(const ColourConfig::Impl& library, const DisplayChoice& choice,
                                       const ColourSpace& space) {
  const glm::dmat3 exposure(std::exp2(choice.exposure));
  ocio::GroupTransformRcPtr steps = ocio::GroupTransform::Create();
  if (isRaw(*library.config, choice)) {
    steps->appendTransform(matrixTransform(exposure));
  } else {
    const KnownSpace known = library.known();
    steps->appendTransform(matrixTransform(known.fromRec709 * glm::inverse(space.fromRec709) * exposure));
    if (!choice.look.empty()) {
      ocio::LookTransformRcPtr look = ocio::LookTransform::Create();
      look->setSrc(known.name.c_str());
      look->setDst(known.name.c_str());
      look->setLooks(choice.look.c_str());
      steps->appendTransform(look);
    }
    ocio::DisplayViewTransformRcPtr shown = ocio::DisplayViewTransform::Create();
    shown->setLooksBypass(!choice.look.empty());
    shown->setSrc(known.name.c_str());
    shown->setDisplay(choice.display.c_str());
    shown->setView(choice.view.c_str());
    steps->appendTransform(shown);
  }
  return library.config->getProcessor(steps);
}

std::vector<float> valuesOf(const float* values, std::size_t count) {
  return {values, values + count};
}

// The text looks the last value up as the first of a second row, which a table of one row does not have. With three
// rows the middle of the texture is the table still, and below it that value stands.
void addLastRow(ShaderTable& table) {
  const std::vector<float> row = table.values;
  const auto last = row.end() - table.channels;
  table.values.insert(table.values.end(), row.begin(), row.end());
  for (int i = 0; i < table.width; ++i) table.values.insert(table.values.end(), last, row.end());
  table.height = 3;
}

ShaderTable flatTable(const ocio::GpuShaderDesc& shader, unsigned index) {
  const char *texture = nullptr, *sampler = nullptr;
  unsigned width = 0, height = 0;
  ocio::GpuShaderDesc::TextureType channels{};
  ocio::Interpolation interpolation{};
  const float* values = nullptr;
  shader.getTexture(index, texture, sampler, width, height, channels, interpolation);
  shader.getTextureValues(index, values);
  ShaderTable table{sampler, static_cast<int>(width), static_cast<int>(height)};
  table.channels = channels == ocio::GpuShaderDesc::TEXTURE_RED_CHANNEL ? 1 : 3;
  table.linear = interpolation != ocio::INTERP_NEAREST;
  table.values = valuesOf(values, std::size_t{width} * height * static_cast<std::size_t>(table.channels));
  if (height == 1) addLastRow(table);
  return table;
}

ShaderTable cubeTable(const ocio::GpuShaderDesc& shader, unsigned index) {
  const char *texture = nullptr, *sampler = nullptr;
  unsigned edge = 0;
  ocio::Interpolation interpolation{};
  const float* values = nullptr;
  shader.get3DTexture(index, texture, sampler, edge, interpolation);
  shader.get3DTextureValues(index, values);
  const int size = static_cast<int>(edge);
  ShaderTable table{sampler, size, size, size};
  table.linear = interpolation != ocio::INTERP_NEAREST;
  table.values = valuesOf(values, std::size_t{edge} * edge * edge * 3);
  return table;
}

}  // namespace

struct DisplayTransform::Impl {
  ocio::ConstProcessorRcPtr steps;
  ocio::ConstCPUProcessorRcPtr processor;
};

DisplayTransform::DisplayTransform(const ColourConfig& config, const DisplayChoice& choice, const ColourSpace& space)
    : impl_(std::make_unique<Impl>()) {
  const DisplayChoice chosen = settled(config.library(), choice);
  try {
    impl_->steps = processorFor(config.library(), chosen, space);
    impl_->processor = impl_->steps->getOptimizedCPUProcessor(ocio::OPTIMIZATION_VERY_GOOD);
  } catch (const ocio::Exception& error) {
    throw InputError(fmt::format("{}: display {}, view {}: {}", config.library().title(), chosen.display, chosen.view,
                                 oneLine(error.what())));
  }
  names_ = fmt::format("display {}, view {}{}", chosen.display, chosen.view,
                       chosen.look.empty() ? "" : ", look " + chosen.look);
  title_ = fmt::format("{}, exposure {:g}", names_, chosen.exposure);
}

DisplayTransform::~DisplayTransform() = default;
DisplayTransform::DisplayTransform(DisplayTransform&&) noexcept = default;

DisplayShader DisplayTransform::shader() const {
  DisplayShader shader{names_, "", {}};
  try {
    ocio::GpuShaderDescRcPtr text = ocio::GpuShaderDesc::CreateShaderDesc();
    text->setLanguage(ocio::GPU_LANGUAGE_GLSL_ES_3_0);
    text->setFunctionName("shown");
    text->setResourcePrefix("shown_");
    impl_->steps->getOptimizedGPUProcessor(ocio::OPTIMIZATION_VERY_GOOD)->extractGpuShaderInfo(text);
    shader.text = text->getShaderText();
    for (unsigned i = 0; i < text->getNumTextures(); ++i) shader.tables.push_back(flatTable(*text, i));
    for (unsigned i = 0; i < text->getNum3DTextures(); ++i) shader.tables.push_back(cubeTable(*text, i));
  } catch (const ocio::Exception& error) {
    throw InputError(fmt::format("{}: found no shader for it: {}", title_, oneLine(error.what())));
  }
  return shader;
}

void DisplayTransform::apply(Image<glm::vec3>& picture) const {
  tbb::parallel_for(0, picture.height(), [&](int y) {
    glm::vec3* row = picture.row(y);
    for (int x = 0; x < picture.width(); ++x)
      for (int c = 0; c < 3; ++c)
        if (!std::isfinite(row[x][c])) row[x][c] = 0.0f;
    ocio::PackedImageDesc pixels(row, picture.width(), 1, 3);
    impl_->processor->apply(pixels);
    for (int x = 0; x < picture.width(); ++x) row[x] = glm::clamp(row[x], glm::vec3(0.0f), glm::vec3(1.0f));
  });
}

void checkDisplay(const ColourConfig& config, const DisplayChoice& choice) {
  settled(config.library(), choice);
}

void writePng(const std::string& path, const Image<glm::vec3>& shown) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i)
    for (int c = 0; c < 3; ++c) bytes.push_back(static_cast<std::uint8_t>(std::lround(shown[i][c] * 255.0f)));
  AtomicFile file(path);
  const std::string problem = imageCodec().writePng(file.temporary(), shown.width(), shown.height(), bytes.data());
  if (!problem.empty()) throw ResourceError(fmt::format("{}: cannot be written: {}", path, problem));
  file.commit();
}

}  // namespace pellucid
