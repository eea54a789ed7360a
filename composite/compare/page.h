// One self-contained HTML page that shows pictures against each other: split slider, error heat map with a legend,
// exposure, zoom that both views share. No network, no other file.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "composite/colour/display.h"
#include "composite/compare/compare.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/image.h"

namespace pellucid {

struct PagePicture {
  std::string name;
  Image<glm::vec3> rgb;  // scene-linear
  int display = -1;      // of Page::displays; -1: numbers that are no colours, shown as greys by the curve of sRGB
};

struct PageTable {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

struct Page {
  std::string title;
  std::vector<std::string> lines;  // what was compared, what came out
  std::vector<PageTable> tables;
  std::string plotSvg;  // one drawing or several, "" for none
  std::vector<PagePicture> pictures;
  int left = 0, right = 1;                   // pictures shown first
  std::vector<DisplayShader> displays = {};  // by which pictures are shown, at 0 stops
  double exposure = 0.0;                     // stops, at first
};

// Text as HTML and SVG show it.
std::string escapedHtml(const std::string& text);

// The page as text. Values are kept as half floats; beyond 65504 they become 65504, and what is not finite stays so.
std::string pageText(const Page& page);

// Writes it whole or not at all. Throws ResourceError.
void writePage(const std::string& path, const Page& page);

//   displays  of colours of A and of B
Page comparePage(const ExrDocument& a, const ExrDocument& b, const CompareReport& report,
                 const std::vector<DisplayShader>& displays);

}  // namespace pellucid
