#include "composite/compare/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "composite/compare/structure.h"
#include "gbuffer/deep_io.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Every bit of a uint, which float would round.
double valueOf(const ExrChannel& channel, std::size_t i) {
  if (channel.type != PixelType::uint32) return static_cast<double>(channel.at(i));
  std::uint32_t value = 0;
  std::memcpy(&value, channel.bytes.data() + i * sizeof value, sizeof value);
  return value;
}

// |a - b|; 0 for the same kind of non-finite value, infinity for a number against one.
double differenceOf(double a, double b) {
  if (std::isfinite(a) && std::isfinite(b)) return std::abs(a - b);
  return (std::isnan(a) && std::isnan(b)) || a == b ? 0.0 : kInfinity;
}

bool exceeds(double difference, double a, double b, const CompareLimit& limit) {
  if (difference == kInfinity) return true;
  const double scale = limit.relative > 0.0 ? std::max(std::abs(a), std::abs(b)) : 0.0;
  return difference > std::max(limit.absolute, limit.relative * scale);
}

// Collects one layer: values go in by pixel.
class LayerJudge {
 public:
  LayerJudge(LayerReport& report, const CompareSettings& settings) : report_(report), settings_(settings) {}

  void beginPixel(int x, int y) {
    x_ = x, y_ = y;
    fails_ = warns_ = false;
    ++report_.pixels;
  }
  void value(const std::string& channel, double a, double b) {
    double difference = differenceOf(a, b);
    const bool finite = std::isfinite(a) && std::isfinite(b);
    if (!finite) {
      if (difference == 0.0)
        ++report_.notFiniteInBoth;
      else
        ++report_.notFinite;
      if (settings_.finiteOnly) difference = kInfinity;
    } else {
      sum_ += difference;
      squares_ += difference * difference;
      ++values_;
    }
    if (difference > 0.0 && (!report_.worst || difference > report_.worst->difference))
      report_.worst = WorstValue{x_, y_, channel, a, b, difference};
    fails_ |= exceeds(difference, a, b, settings_.fail);
    warns_ |= exceeds(difference, a, b, settings_.warn);
  }
  // Pixels whose samples do not pair up at all.
  void mismatch(const std::string& what, double a, double b) {
    if (!report_.worst || report_.worst->difference < kInfinity)
      report_.worst = WorstValue{x_, y_, what, a, b, kInfinity};
    ++report_.notFinite;
    fails_ = warns_ = true;
  }
  void endPixel() {
    report_.failing += fails_;
    report_.warning += warns_;
  }
  void finish() {
    if (values_ > 0) {
      report_.mean = sum_ / static_cast<double>(values_);
      report_.rms = std::sqrt(squares_ / static_cast<double>(values_));
    }
    const bool strict = report_.notFinite > 0 || (settings_.finiteOnly && report_.notFiniteInBoth > 0);
    if (strict || over(report_.failing, settings_.fail, settings_.allowedFailures))
      report_.verdict = Verdict::failed;
    else if (over(report_.warning, settings_.warn, 0))
      report_.verdict = Verdict::warned;
  }

 private:
  bool over(std::size_t count, const CompareLimit& limit, std::size_t allowed) const {
    if (report_.worst && report_.worst->difference > limit.hard) return true;
    return count > allowed && static_cast<double>(count) > limit.percent / 100.0 * static_cast<double>(report_.pixels);
  }
  LayerReport& report_;
  const CompareSettings& settings_;
  int x_ = 0, y_ = 0;
  bool fails_ = false, warns_ = false;
  double sum_ = 0, squares_ = 0;
  std::size_t values_ = 0;
};

Window sharedWindow(const Window& a, const Window& b) {
  Window both{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  both.x1 = std::max(both.x1, both.x0);
  both.y1 = std::max(both.y1, both.y0);
  return both;
}

std::size_t indexIn(const Window& window, int x, int y) {
  return static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.width()) +
         static_cast<std::size_t>(x - window.x0);
}

void compareFlat(const std::vector<const ChannelPair*>& pairs, LayerJudge& judge) {
  const Window a = pairs[0]->partA->data, b = pairs[0]->partB->data, both = sharedWindow(a, b);
  for (int y = both.y0; y < both.y1; ++y)
    for (int x = both.x0; x < both.x1; ++x) {
      judge.beginPixel(x, y);
      for (const ChannelPair* pair : pairs)
        judge.value(pair->name, valueOf(*pair->a, indexIn(a, x, y)), valueOf(*pair->b, indexIn(b, x, y)));
      judge.endPixel();
    }
}

void compareDeep(const std::vector<const ChannelPair*>& pairs, const ExrDocument& documentA,
                 const ExrDocument& documentB, LayerJudge& judge) {
  std::vector<std::string> names;
  for (const ChannelPair* pair : pairs) names.push_back(pair->a->name);
  const auto partOf = [](const ExrDocument& document, const ExrPart* part) {
    return static_cast<int>(part - document.parts.data());
  };
  DeepReader readerA(documentA.path, partOf(documentA, pairs[0]->partA), names);
  DeepReader readerB(documentB.path, partOf(documentB, pairs[0]->partB), names);
  const Window a = readerA.data(), b = readerB.data(), both = sharedWindow(a, b);
  for (int y = both.y0; y < both.y1; ++y) {
    const DeepRows rowsA = readerA.read(y, y + 1), rowsB = readerB.read(y, y + 1);
    for (int x = both.x0; x < both.x1; ++x) {
      judge.beginPixel(x, y);
      const auto ia = static_cast<std::size_t>(x - a.x0), ib = static_cast<std::size_t>(x - b.x0);
      const std::uint64_t fromA = rowsA.offsets[ia], fromB = rowsB.offsets[ib];
      const std::uint64_t countA = rowsA.offsets[ia + 1] - fromA, countB = rowsB.offsets[ib + 1] - fromB;
      if (countA != countB) {
        judge.mismatch("samples", static_cast<double>(countA), static_cast<double>(countB));
      } else {
        for (std::uint64_t s = 0; s < countA; ++s)
          for (std::size_t c = 0; c < names.size(); ++c)
            judge.value(pairs[c]->name, static_cast<double>(rowsA.channels[c][fromA + s]),
                        static_cast<double>(rowsB.channels[c][fromB + s]));
      }
      judge.endPixel();
    }
  }
}

const char* wordFor(Verdict verdict) {
  return verdict == Verdict::same ? "same" : verdict == Verdict::warned ? "WARNING" : "FAILURE";
}

}  // namespace

CompareReport compareExr(const ExrDocument& a, const ExrDocument& b, const CompareSettings& settings) {
  CompareReport report;
  const std::vector<ChannelPair> pairs = pairChannels(a, b, report);
  if (settings.metadata != MetadataRule::ignore) compareAttributes(a, b, settings, report);
  std::vector<std::string> order;
  for (const ChannelPair& pair : pairs)
    if (std::find(order.begin(), order.end(), pair.layer) == order.end()) order.push_back(pair.layer);
  for (const std::string& wanted : settings.layers)
    if (std::find(order.begin(), order.end(), wanted) == order.end())
      throw UsageError(
          fmt::format("--layer: found '{}', expected one that both files have ({})", wanted, fmt::join(order, ", ")));
  for (const std::string& layer : order) {
    if (!settings.layers.empty() &&
        std::find(settings.layers.begin(), settings.layers.end(), layer) == settings.layers.end())
      continue;
    LayerReport entry;
    entry.name = layer;
    std::vector<const ChannelPair*> members;
    for (const ChannelPair& pair : pairs)
      if (pair.layer == layer) {
        members.push_back(&pair);
        entry.channels.push_back(pair.name);
      }
    LayerJudge judge(entry, settings);
    if (members[0]->partA->deep)
      compareDeep(members, a, b, judge);
    else
      compareFlat(members, judge);
    judge.finish();
    report.layers.push_back(std::move(entry));
  }
  for (const LayerReport& layer : report.layers) report.verdict = std::max(report.verdict, layer.verdict);
  if (!report.metadata.empty())
    report.verdict =
        std::max(report.verdict, settings.metadata == MetadataRule::fail ? Verdict::failed : Verdict::warned);
  if (!report.structure.empty()) report.verdict = Verdict::failed;
  return report;
}

std::string reportText(const CompareReport& report, const std::string& a, const std::string& b) {
  std::string text = fmt::format("{}: {} against {}\n", wordFor(report.verdict), a, b);
  for (const std::string& sentence : report.structure) text += "  structure: " + sentence + "\n";
  for (const std::string& sentence : report.metadata) text += "  metadata: " + sentence + "\n";
  for (const LayerReport& layer : report.layers) {
    const double percent =
        layer.pixels ? 100.0 * static_cast<double>(layer.failing) / static_cast<double>(layer.pixels) : 0.0;
    text += fmt::format("  layer {}: {}: mean {:.3g}, rms {:.3g}, {} of {} pixels over ({:.3g} %)",
                        layer.name.empty() ? "(no name)" : layer.name, wordFor(layer.verdict), layer.mean, layer.rms,
                        layer.failing, layer.pixels, percent);
    if (layer.worst)
      text +=
          fmt::format(", worst at ({}, {}) {}: {:.9g} against {:.9g}, off by {:.3g}", layer.worst->x, layer.worst->y,
                      layer.worst->channel, layer.worst->a, layer.worst->b, layer.worst->difference);
    if (layer.notFinite) text += fmt::format(", {} values finite in one file only", layer.notFinite);
    if (layer.notFiniteInBoth) text += fmt::format(", {} values not finite in both", layer.notFiniteInBoth);
    text += "\n";
  }
  return text;
}

}  // namespace pellucid
