#include "tests/support/outline_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace pellucid::test {
namespace {

constexpr double kReach = 2.3;       // pixels from the edge to where its filter no longer mixes
constexpr double kSide = 5.0;        // and to where the colour of either side is taken from
constexpr double kBlock = 2.0;       // pixels of an edge whose sides are taken as one colour each
constexpr double kEnds = 3.0;        // of an edge, left out: the filter sees the corner there
constexpr double kUneven = 0.02;     // part of the step between both colours by which a side may vary
constexpr double kLeastStep = 0.03;  // between the colours: below it the noise of the samples counts
constexpr std::size_t kFewest = 40;  // pixels that fix a line
constexpr double kLongEnough = 0.5;  // part of the edge that they have to span
constexpr double kWorstFit = 0.01;   // RMS of the coverage that the line leaves; 256 samples leave about 0.003
// Pixels, standard error of an end of a line: 0.004 where one step of colour shows, more where anything else does.
constexpr double kUncertain = 0.005;

double crossOf(glm::dvec2 a, glm::dvec2 b) {
  return a.x * b.y - a.y * b.x;
}

// Share of the filter below a distance along a direction, as a table.
class StepResponse {
 public:
  StepResponse(const FilterProfile& filter, glm::dvec2 direction) {
    constexpr int kPlaces = 61;
    double total = 0.0;
    for (int i = 0; i < kPlaces; ++i)
      for (int j = 0; j < kPlaces; ++j) {
        const double x = ((i + 0.5) / kPlaces * 2.0 - 1.0) * filter.radius;
        const double y = ((j + 0.5) / kPlaces * 2.0 - 1.0) * filter.radius;
        const double weight = filter.density(x) * filter.density(y);
        const double at = (x * direction.x + y * direction.y + kReach) / (2.0 * kReach) * kBins;
        below_[static_cast<std::size_t>(at) + 1] += weight;
        total += weight;
      }
    for (std::size_t i = 1; i < below_.size(); ++i) below_[i] = below_[i] / total + below_[i - 1];
  }
  double at(double distance) const {
    const double place = std::clamp((distance + kReach) / (2.0 * kReach), 0.0, 1.0) * kBins;
    const auto first = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(kBins - 1));
    return below_[first] + (below_[first + 1] - below_[first]) * (place - static_cast<double>(first));
  }
  double slopeAt(double distance) const { return (at(distance + 0.01) - at(distance - 0.01)) / 0.02; }

 private:
  static constexpr int kBins = 460;
  std::vector<double> below_ = std::vector<double>(kBins + 1, 0.0);
};

struct Edge {
  glm::dvec2 from{0.0}, along{0.0}, outward{0.0};
  double length = 0.0;
};

// A pixel that the edge runs through.
struct Mixed {
  double across = 0.0;    // pixels from the expected edge, outwards
  double place = 0.0;     // along it, 0 to 1
  double coverage = 0.0;  // part of its colour that is the inner one
};

struct FittedLine {
  glm::dvec2 moved{0.0};  // outwards, at both ends
  glm::dvec2 error{0.0};
};

struct MeanColour {
  glm::dvec3 sum{0.0};
  std::vector<glm::dvec3> colours;
  void add(const glm::dvec3& colour) {
    sum += colour;
    colours.push_back(colour);
  }
  glm::dvec3 mean() const { return sum / static_cast<double>(colours.size()); }
  double spread() const {
    double most = 0.0;
    for (const glm::dvec3& colour : colours) {
      const glm::dvec3 apart = glm::abs(colour - mean());
      most = std::max({most, apart.x, apart.y, apart.z});
    }
    return most;
  }
};

// The pixels of a block of an edge, if nothing but the edge shows there.
void addBlock(const Image<glm::vec4>& picture, const Edge& edge, double begin, std::vector<Mixed>& all) {
  MeanColour inner, outer;
  std::vector<std::pair<Mixed, glm::dvec3>> between;
  const glm::dvec2 middle = edge.from + edge.along * (begin + 0.5 * kBlock);
  const int reach = static_cast<int>(kSide + kBlock) + 1;
  for (int y = static_cast<int>(middle.y) - reach; y <= static_cast<int>(middle.y) + reach; ++y)
    for (int x = static_cast<int>(middle.x) - reach; x <= static_cast<int>(middle.x) + reach; ++x) {
      const glm::dvec2 apart = glm::dvec2(x + 0.5, y + 0.5) - edge.from;
      const double across = glm::dot(apart, edge.outward), along = glm::dot(apart, edge.along);
      if (along < begin || along >= begin + kBlock || std::abs(across) >= kSide) continue;
      if (x < 0 || y < 0 || x >= picture.width() || y >= picture.height()) return;
      const glm::dvec3 colour(picture.at(x, y));
      if (std::abs(across) < kReach)
        between.push_back({{across, along / edge.length, 0.0}, colour});
      else
        (across < 0.0 ? inner : outer).add(colour);
    }
  if (inner.colours.size() < 3 || outer.colours.size() < 3 || between.size() < 3) return;
  const glm::dvec3 step = inner.mean() - outer.mean();
  const double size = glm::length(step);
  if (size < kLeastStep || inner.spread() > kUneven * size || outer.spread() > kUneven * size) return;
  for (auto& [mixed, colour] : between) {
    mixed.coverage = glm::dot(colour - outer.mean(), step) / (size * size);
    if (glm::length(colour - outer.mean() - mixed.coverage * step) > kUneven * size) return;
  }
  for (const auto& [mixed, colour] : between) all.push_back(mixed);
}

std::optional<FittedLine> fittedLine(const Image<glm::vec4>& picture, const Edge& edge, const FilterProfile& filter) {
  std::vector<Mixed> pixels;
  for (double begin = kEnds; begin + kBlock <= edge.length - kEnds; begin += kBlock)
    addBlock(picture, edge, begin, pixels);
  if (pixels.size() < kFewest) return std::nullopt;
  const auto [first, last] = std::minmax_element(pixels.begin(), pixels.end(),
                                                 [](const Mixed& a, const Mixed& b) { return a.place < b.place; });
  if (last->place - first->place < kLongEnough) return std::nullopt;
  const StepResponse response(filter, edge.outward);
  FittedLine line;
  glm::dmat2 normal(0.0);
  double squares = 0.0;
  for (int step = 0; step < 8; ++step) {  // Gauss-Newton: it stands still after four
    normal = glm::dmat2(0.0);
    glm::dvec2 right(0.0);
    squares = 0.0;
    for (const Mixed& pixel : pixels) {
      const glm::dvec2 share(1.0 - pixel.place, pixel.place);
      const double inside = glm::dot(line.moved, share) - pixel.across;
      const double left = pixel.coverage - response.at(inside);
      const glm::dvec2 slope = share * response.slopeAt(inside);
      normal += glm::outerProduct(slope, slope);
      right += slope * left;
      squares += left * left;
    }
    if (!(std::abs(glm::determinant(normal)) > 0.0)) return std::nullopt;
    line.moved += glm::inverse(normal) * right;
  }
  const auto count = static_cast<double>(pixels.size());
  if (!(std::sqrt(squares / count) <= kWorstFit)) return std::nullopt;
  const glm::dmat2 covariance = glm::inverse(normal) * (squares / (count - 2.0));
  line.error = {std::sqrt(covariance[0][0]), std::sqrt(covariance[1][1])};
  if (!(std::max(line.error.x, line.error.y) <= kUncertain)) return std::nullopt;
  return line;
}

}  // namespace

std::vector<glm::dvec2> hullOf(std::vector<glm::dvec2> points) {
  std::sort(points.begin(), points.end(),
            [](glm::dvec2 a, glm::dvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<glm::dvec2> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = hull.size();
    for (const glm::dvec2 point : points) {
      while (hull.size() >= start + 2 &&
             crossOf(hull.back() - hull[hull.size() - 2], point - hull[hull.size() - 2]) <= 0.0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // the other half begins with it
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

MeasuredOutline measureOutline(const Image<glm::vec4>& picture, const std::vector<glm::dvec2>& outline,
                               const FilterProfile& filter) {
  double area = 0.0;
  const std::size_t count = outline.size();
  for (std::size_t i = 0; i < count; ++i) area += crossOf(outline[i], outline[(i + 1) % count]);
  std::vector<Edge> edges;
  std::vector<std::optional<FittedLine>> lines;
  MeasuredOutline measured;
  for (std::size_t i = 0; i < count; ++i) {
    Edge edge;
    edge.from = outline[i];
    edge.length = glm::length(outline[(i + 1) % count] - edge.from);
    edge.along = (outline[(i + 1) % count] - edge.from) / edge.length;
    edge.outward = glm::dvec2(edge.along.y, -edge.along.x) * (area > 0.0 ? 1.0 : -1.0);
    edges.push_back(edge);
    lines.push_back(fittedLine(picture, edge, filter));
    if (!lines.back()) continue;
    ++measured.edges;
    const glm::dvec2 moved = glm::abs(lines.back()->moved);
    measured.worstEdge = std::max({measured.worstEdge, moved.x, moved.y});
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = (i + count - 1) % count;
    if (!lines[before] || !lines[i]) continue;
    // Where both moved lines meet. Rows of `outwards` are the edges' normals.
    const glm::dmat2 outwards = glm::transpose(glm::dmat2(edges[before].outward, edges[i].outward));
    if (std::abs(glm::determinant(outwards)) < 0.3) continue;  // so blunt that no corner can be told
    const glm::dmat2 inverse = glm::inverse(outwards);
    MeasuredCorner corner;
    corner.expected = outline[i];
    corner.apart = inverse * glm::dvec2(lines[before]->moved.y, lines[i]->moved.x);
    corner.uncertainty =
        std::hypot(glm::length(inverse[0]) * lines[before]->error.y, glm::length(inverse[1]) * lines[i]->error.x);
    measured.corners.push_back(corner);
  }
  return measured;
}

}  // namespace pellucid::test
