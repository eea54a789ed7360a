#include "composite/compare/page.h"

#include <Imath/half.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "composite/compare/page_frame.h"
#include "composite/compare/page_layers.h"
#include "gbuffer/atomic_file.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

std::string base64(const std::vector<unsigned char>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = static_cast<unsigned>(bytes[i]) << 16;
    if (i + 1 < bytes.size()) word |= static_cast<unsigned>(bytes[i + 1]) << 8;
    if (i + 2 < bytes.size()) word |= bytes[i + 2];
    text += kDigits[word >> 18];
    text += kDigits[word >> 12 & 63];
    text += i + 1 < bytes.size() ? kDigits[word >> 6 & 63] : '=';
    text += i + 2 < bytes.size() ? kDigits[word & 63] : '=';
  }
  return text;
}

std::uint16_t halfBits(float value) {
  if (std::isfinite(value)) value = std::clamp(value, -65504.0f, 65504.0f);
  return imath_float_to_half(value);
}

// Half floats, one channel after the other, low bytes before high bytes: so they deflate to about half their size.
std::string packed(const Image<glm::vec3>& rgb) {
  const std::size_t values = rgb.size() * 3;
  std::vector<unsigned char> plain(values * 2);
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < rgb.size(); ++i) {
      const std::uint16_t bits = halfBits(rgb[i][c]);
      const std::size_t at = static_cast<std::size_t>(c) * rgb.size() + i;
      plain[at] = static_cast<unsigned char>(bits & 255u);
      plain[values + at] = static_cast<unsigned char>(bits >> 8);
    }
  uLongf size = compressBound(static_cast<uLong>(plain.size()));
  std::vector<unsigned char> deflated(size);
  if (compress2(deflated.data(), &size, plain.data(), static_cast<uLong>(plain.size()), 6) != Z_OK)
    throw ResourceError("the page cannot be made: memory ran out");
  deflated.resize(size);
  return base64(deflated);
}

// Floats, low bytes first.
std::string packed(const std::vector<float>& values) {
  std::vector<unsigned char> bytes(values.size() * sizeof(float));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return base64(bytes);
}

nlohmann::json jsonOf(const DisplayShader& display) {
  nlohmann::json json{{"title", display.title}, {"shader", display.text}, {"tables", nlohmann::json::array()}};
  for (const ShaderTable& table : display.tables)
    json["tables"].push_back({{"sampler", table.sampler},
                              {"width", table.width},
                              {"height", table.height},
                              {"depth", table.depth},
                              {"channels", table.channels},
                              {"linear", table.linear},
                              {"data", packed(table.values)}});
  return json;
}

std::string tableHtml(const PageTable& table) {
  std::string html = "<h2>" + escapedHtml(table.title) + "</h2><table><tr>";
  for (const std::string& cell : table.head) html += "<th>" + escapedHtml(cell) + "</th>";
  html += "</tr>";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + escapedHtml(cell) + "</td>";
    html += "</tr>";
  }
  return html + "</table>\n";
}

// Text inside a script element: "</script" and "<!--" would end or change it.
std::string scriptSafe(std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos; at += 6) json.replace(at, 1, "\\u003c");
  return json;
}

}  // namespace

std::string escapedHtml(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '&')
      safe += "&amp;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

std::string pageText(const Page& page) {
  nlohmann::json data{{"left", page.left},
                      {"right", page.right},
                      {"exposure", page.exposure},
                      {"displays", nlohmann::json::array()},
                      {"pictures", nlohmann::json::array()}};
  for (const DisplayShader& display : page.displays) data["displays"].push_back(jsonOf(display));
  for (const PagePicture& picture : page.pictures)
    data["pictures"].push_back({{"name", picture.name},
                                {"width", picture.rgb.width()},
                                {"height", picture.rgb.height()},
                                {"display", picture.display},
                                {"data", packed(picture.rgb)}});
  std::string body = "<h1>" + escapedHtml(page.title) + "</h1>\n";
  for (const std::string& line : page.lines) body += "<p>" + escapedHtml(line) + "</p>\n";
  if (!page.pictures.empty()) body += kPageViews;
  body += page.plotSvg;
  for (const PageTable& table : page.tables) body += tableHtml(table);
  std::string html = kPageHead;
  html += "<title>" + escapedHtml(page.title) + "</title></head><body>\n" + body;
  if (!page.pictures.empty()) {
    // File names need not be UTF-8; what is not becomes a replacement character.
    html += "<script id=\"data\" type=\"application/json\">" +
            scriptSafe(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) + "</script>\n<script>";
    html += kPageDisplayScript;
    html += kPageScript;
    html += "</script>\n";
  }
  return html + "</body></html>\n";
}

void writePage(const std::string& path, const Page& page) {
  const std::string text = pageText(page);
  AtomicFile file(path);
  std::ofstream out(file.temporary(), std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) throw ResourceError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  file.commit();
}

Page comparePage(const ExrDocument& a, const ExrDocument& b, const CompareReport& report,
                 const std::vector<DisplayShader>& displays) {
  Page page;
  page.displays = displays;
  page.title = a.path + " against " + b.path;
  page.lines.push_back(report.verdict == Verdict::failed   ? "They differ."
                       : report.verdict == Verdict::warned ? "They differ within the limits, with warnings."
                                                           : "They are the same within the limits.");
  for (const std::string& sentence : report.structure) page.lines.push_back("Structure: " + sentence + ".");
  for (const std::string& sentence : report.metadata) page.lines.push_back("Metadata: " + sentence + ".");
  PageTable table{"Layers", {"layer", "verdict", "mean", "rms", "pixels over", "of", "worst", "at"}, {}};
  for (const LayerReport& layer : report.layers)
    table.rows.push_back(
        {layer.name.empty() ? "(no name)" : layer.name,
         layer.verdict == Verdict::failed   ? "FAIL"
         : layer.verdict == Verdict::warned ? "warn"
                                            : "same",
         fmt::format("{:.4g}", layer.mean), fmt::format("{:.4g}", layer.rms), fmt::format("{}", layer.failing),
         fmt::format("{}", layer.pixels), layer.worst ? fmt::format("{:.4g}", layer.worst->difference) : "0",
         layer.worst ? fmt::format("{} ({}, {})", layer.worst->channel, layer.worst->x, layer.worst->y) : ""});
  page.tables.push_back(std::move(table));
  for (const LayerReport& layer : report.layers)
    for (const ExrDocument* document : {&a, &b})
      for (const ExrPart& part : document->parts) {
        if (part.deep) continue;
        const bool named = document->parts.size() > 1 && !part.name.empty();
        if (named && layer.name.rfind(part.name, 0) != 0) continue;
        const std::string inner = !named                                 ? layer.name
                                  : layer.name.size() > part.name.size() ? layer.name.substr(part.name.size() + 1)
                                                                         : "";
        const std::vector<const ExrChannel*> shown = shownChannels(part, inner);
        if (shown.empty()) continue;
        page.pictures.push_back({(document == &a ? "A " : "B ") + layer.name, layerPicture(part, shown),
                                 areColours(shown) ? (document == &a ? 0 : 1) : -1});
        break;
      }
  page.right = page.pictures.size() > 1 ? 1 : 0;
  return page;
}

}  // namespace pellucid
