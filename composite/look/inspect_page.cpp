#include "composite/look/inspect_page.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <sstream>

#include "composite/compare/page_layers.h"
#include "composite/look/depth_histogram.h"

namespace pellucid {
namespace {

constexpr double kMostPixels = 16e6;

struct LayerOfPart {
  std::string name;  // "part: layer"
  const ExrPart* part;
  std::vector<const ExrChannel*> channels;
};

std::vector<LayerOfPart> layersOf(const ExrDocument& document) {
  std::vector<LayerOfPart> layers;
  for (const ExrPart& part : document.parts) {
    if (part.deep) continue;
    std::set<std::string> names;
    for (const ExrChannel& channel : part.channels) {
      const auto dot = channel.name.rfind('.');
      names.insert(dot == std::string::npos ? "" : channel.name.substr(0, dot));
    }
    for (const std::string& name : names) {
      const std::string layer = name.empty() ? "(no name)" : name;
      layers.push_back({part.name.empty() ? layer : part.name + ": " + layer, &part, shownChannels(part, name)});
    }
  }
  return layers;
}

// So that all pictures together stay within what a browser takes.
int stepFor(const std::vector<LayerOfPart>& layers) {
  double pixels = 0;
  for (const LayerOfPart& layer : layers)
    pixels += static_cast<double>(layer.part->data.width()) * static_cast<double>(layer.part->data.height());
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / kMostPixels))));
}

// Metres as greys: the nearest is white, the farthest dark, by ratio; black where nothing was hit.
PagePicture depthPicture(const Image<float>& viewZ, const DepthBins& bins, int step) {
  PagePicture picture{"depth as greys, near is bright",
                      Image<glm::vec3>((viewZ.width() + step - 1) / step, (viewZ.height() + step - 1) / step)};
  const double span = bins.farthest > bins.nearest ? std::log(bins.farthest / bins.nearest) : 1.0;
  for (int y = 0; y < picture.rgb.height(); ++y)
    for (int x = 0; x < picture.rgb.width(); ++x) {
      const double z = static_cast<double>(viewZ.at(x * step, y * step));
      const double grey = std::isfinite(z) ? 1.0 - 0.95 * std::log(z / bins.nearest) / span : 0.0;
      picture.rgb.at(x, y) = glm::vec3(static_cast<float>(grey));
    }
  return picture;
}

Image<glm::vec3> flatPicture(const Image<glm::vec4>& beauty) {
  Image<glm::vec3> picture(beauty.width(), beauty.height());
  for (std::size_t i = 0; i < picture.size(); ++i) picture[i] = glm::vec3(beauty[i]);
  return picture;
}

PageTable channelTable(const ExrDocument& document) {
  PageTable table{"Channels", {"channel", "type", "part", "data window"}, {}};
  for (std::size_t i = 0; i < document.parts.size(); ++i) {
    const ExrPart& part = document.parts[i];
    const Window& data = part.data;
    for (const ExrChannel& channel : part.channels)
      table.rows.push_back({channel.name, std::string(part.deep ? "deep " : "") + nameOf(channel.type),
                            part.name.empty() ? fmt::format("{}", i) : part.name,
                            fmt::format("{} x {} at ({}, {})", data.width(), data.height(), data.x0, data.y0)});
  }
  return table;
}

}  // namespace

Page inspectPage(const ExrDocument& document, const std::string& report,
                 const std::optional<UnderstoodShot>& understood, const std::optional<SceneLook>& scene,
                 const DisplayShader& shown) {
  Page page;
  page.title = document.path;
  page.displays = {shown};
  std::istringstream lines(report);
  // Rows that are set in are in the tables and the histogram.
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("  ", 0) != 0 && line != document.path) page.lines.push_back(line);
  const std::vector<LayerOfPart> layers = layersOf(document);
  const int step = stepFor(layers);
  if (step > 1) page.lines.push_back(fmt::format("Pictures show one pixel of {} in both axes.", step));
  if (scene) {
    page.lines.insert(page.lines.end(), scene->lines.begin(), scene->lines.end());
    page.pictures = scene->pictures;
    page.tables = scene->tables;
  }
  if (understood) {
    const GBuffer& gbuffer = understood->file->gbuffer;
    const DepthBins bins = depthBins(gbuffer.viewZ);
    page.pictures.push_back(depthPicture(gbuffer.viewZ, bins, step));
    if (layers.empty()) page.pictures.push_back({"flattened", flatPicture(gbuffer.beauty), 0});
    page.plotSvg = histogramSvg(bins);
    if (understood->camera)
      page.plotSvg += planSvg(gbuffer, *understood->camera, scene ? scene->parts : std::vector<ScenePart>());
  }
  const std::size_t own = page.pictures.size();
  for (const LayerOfPart& layer : layers)
    page.pictures.push_back(
        {layer.name, layerPicture(*layer.part, layer.channels, step), areColours(layer.channels) ? 0 : -1});
  // The picture first, whatever stands before it in the file.
  const std::string beauty = understood ? understood->file->choice.beautyChannel[0] : "";
  for (std::size_t i = 0; i < layers.size(); ++i)
    if (!beauty.empty() && layers[i].channels[0]->name == beauty) page.left = static_cast<int>(own + i);
  if (page.left == 0) page.left = static_cast<int>(own < page.pictures.size() ? own : 0);
  page.right = scene && !scene->pictures.empty() ? 0 : page.left;
  page.tables.push_back(channelTable(document));
  return page;
}

}  // namespace pellucid
