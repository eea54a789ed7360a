#include "composite/look/plan_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "composite/compare/page.h"
#include "gbuffer/view_point.h"

namespace pellucid {
namespace {

constexpr double kWidth = 720, kHeight = 480, kMargin = 24;
constexpr int kDotsAcross = 96;          // of the picture
constexpr glm::dvec2 kNameSize{60, 12};  // names nearer to one another than this would overlap

struct Dot {
  glm::dvec2 at;
  std::string colour;
};

struct Frame {
  glm::dvec2 least, most;
  double scale;  // pixels a metre
  glm::dvec2 place(glm::dvec2 world) const { return glm::dvec2(kMargin) + (world - least) * scale; }
};

glm::dvec2 fromAbove(const glm::dvec3& world) {
  return {world.x, world.z};
}

int displayed(float value) {
  return static_cast<int>(255.0 * std::pow(std::clamp(static_cast<double>(value), 0.0, 1.0), 1.0 / 2.2));
}

std::vector<Dot> dotsOf(const GBuffer& gbuffer, const Camera& camera) {
  const glm::dmat4 worldFromView = glm::inverse(camera.viewFromWorld);
  const int step = std::max(1, gbuffer.data.width() / kDotsAcross);
  std::vector<Dot> dots;
  for (int y = step / 2; y < gbuffer.data.height(); y += step)
    for (int x = step / 2; x < gbuffer.data.width(); x += step) {
      if (!std::isfinite(gbuffer.viewZ.at(x, y))) continue;
      const glm::vec4& colour = gbuffer.beauty.at(x, y);
      dots.push_back(
          {fromAbove(glm::dvec3(worldFromView * glm::dvec4(viewPoint(gbuffer, camera, x, y), 1.0))),
           fmt::format("#{:02x}{:02x}{:02x}", displayed(colour.r), displayed(colour.g), displayed(colour.b))});
    }
  return dots;
}

// The middle of the dots, so that one far wall of a landscape does not shrink everything else to a point.
void addMiddle(const std::vector<Dot>& dots, glm::dvec2& least, glm::dvec2& most) {
  if (dots.empty()) return;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> values;
    for (const Dot& dot : dots) values.push_back(dot.at[axis]);
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / 50;
    least[axis] = std::min(least[axis], values[cut]);
    most[axis] = std::max(most[axis], values[values.size() - 1 - cut]);
  }
}

Frame frameOf(const std::vector<Dot>& dots, const glm::dvec2& eye, const std::vector<ScenePart>& parts) {
  Frame frame{eye, eye, 1.0};
  addMiddle(dots, frame.least, frame.most);
  for (const ScenePart& part : parts) {
    if (!part.transparent) continue;
    frame.least = glm::min(frame.least, fromAbove(part.least));
    frame.most = glm::max(frame.most, fromAbove(part.most));
  }
  const glm::dvec2 size = glm::max(frame.most - frame.least, glm::dvec2(1e-3));
  frame.scale = std::min((kWidth - 2 * kMargin) / size.x, (kHeight - 2 * kMargin) / size.y);
  return frame;
}

// The two sides of what it sees, from the eye to beyond the drawing.
std::string cameraSvg(const GBuffer& gbuffer, const Camera& camera, const Frame& frame, const glm::dvec2& eye) {
  const glm::dmat4 worldFromView = glm::inverse(camera.viewFromWorld);
  const double far = 2.0 * (kWidth + kHeight) / frame.scale, middle = 0.5 * gbuffer.data.height() - 0.5;
  const auto seen = [&](double x, double z) {
    return frame.place(
        fromAbove(glm::dvec3(worldFromView * glm::dvec4(viewPoint(gbuffer, camera, {x, middle}, z), 1.0))));
  };
  std::string svg;
  for (const double x : {-0.5, gbuffer.data.width() - 0.5}) {
    const glm::dvec2 from = seen(x, 0.0), to = seen(x, far);
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#c33\" fill=\"none\"/>", from.x, from.y, to.x,
                       to.y);
  }
  const glm::dvec2 at = frame.place(eye);
  return svg + fmt::format(
                   "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"#c33\"/>"
                   "<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"#c33\">camera</text>",
                   at.x, at.y, at.x + 8, at.y + 4);
}

std::string partsSvg(const std::vector<ScenePart>& parts, const Frame& frame) {
  std::string svg;
  std::vector<glm::dvec2> names;
  const auto hasRoom = [&](const glm::dvec2& at) {
    return std::none_of(names.begin(), names.end(), [&](const glm::dvec2& other) {
      return std::abs(at.x - other.x) < kNameSize.x && std::abs(at.y - other.y) < kNameSize.y;
    });
  };
  for (const ScenePart& part : parts) {
    const glm::dvec2 from = frame.place(fromAbove(part.least)), to = frame.place(fromAbove(part.most));
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" fill-opacity=\"0.25\" "
        "stroke=\"{}\"><title>{}</title></rect>",
        from.x, from.y, std::max(to.x - from.x, 1.0), std::max(to.y - from.y, 1.0), part.transparent ? "#2a7" : "none",
        part.transparent ? "#2a7" : "#999", escapedHtml(part.name));
    if (!part.transparent || !hasRoom(from)) continue;
    names.push_back(from);
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"#175\">{}</text>", from.x, from.y - 2,
                       escapedHtml(part.name));
  }
  return svg;
}

// A round length that takes about a quarter of the width.
std::string scaleSvg(const Frame& frame) {
  const double quarter = kWidth / 4 / frame.scale, decade = std::pow(10.0, std::floor(std::log10(quarter)));
  const double length = decade * (quarter / decade >= 5 ? 5 : quarter / decade >= 2 ? 2 : 1);
  return fmt::format(
      "<path d=\"M{0} {1}h{2:.1f}\" stroke=\"#222\" stroke-width=\"3\"/><text x=\"{0}\" y=\"{3}\">{4:g} "
      "m</text>",
      kMargin, kHeight - 10, length * frame.scale, kHeight - 15, length);
}

}  // namespace

std::string planSvg(const GBuffer& gbuffer, const Camera& camera, const std::vector<ScenePart>& parts) {
  const glm::dvec2 eye = fromAbove(glm::dvec3(glm::inverse(camera.viewFromWorld)[3]));
  const std::vector<Dot> dots = dotsOf(gbuffer, camera);
  const Frame frame = frameOf(dots, eye, parts);
  std::string svg = fmt::format(
      "<svg class=\"plan\" xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">",
      kWidth, kHeight);
  for (const Dot& dot : dots) {
    const glm::dvec2 at = frame.place(dot.at);
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.5\" fill=\"{}\"/>", at.x, at.y, dot.colour);
  }
  return svg + partsSvg(parts, frame) + cameraSvg(gbuffer, camera, frame, eye) + scaleSvg(frame) +
         "<text x=\"24\" y=\"16\">From above: x to the right, z downwards; dots are what the picture shows, boxes the "
         "scene</text></svg>\n";
}

}  // namespace pellucid
