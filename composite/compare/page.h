// One self-contained HTML page that shows pictures against each other: split slider, error heat map with a legend,
// exposure, zoom that both views share. No network, no other file.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "composite/compare/compare.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/image.h"

namespace pellucid {

struct PagePicture {
  std::string name;
  Image<glm::vec3> rgb;  // scene-linear
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
  int left = 0, right = 1;  // pictures shown first
};

// Text as HTML and SVG show it.
std::string escapedHtml(const std::string& text);

// The page as text. Values are kept as half floats; beyond 65504 they become 65504, and what is not finite stays so.
std::string pageText(const Page& page);

// Writes it whole or not at all. Throws ResourceError.
void writePage(const std::string& path, const Page& page);

Page comparePage(const ExrDocument& a, const ExrDocument& b, const CompareReport& report);

}  // namespace pellucid
