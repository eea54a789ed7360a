// The study's plot as a PNG, lines and letters by OpenImageIO.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include <cmath>

#include "composite/study/plot.h"
#include "gbuffer/atomic_file.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr const char* kFont = "DejaVuSans";

bool writePng(const std::string& path, const Plot& plot) {
  // Twice as large, then halved: lines and dots come out smooth.
  constexpr int kScale = 2;
  using namespace OIIO;
  ImageBuf large(ImageSpec(plot.width * kScale, plot.height * kScale, 3, TypeDesc::FLOAT));
  ImageBufAlgo::fill(large, {1.0f, 1.0f, 1.0f});
  const float grid[] = {0.87f, 0.87f, 0.87f}, leader[] = {0.73f, 0.73f, 0.8f}, red[] = {0.8f, 0.2f, 0.2f},
              blue[] = {0.27f, 0.33f, 0.4f}, black[] = {0.0f, 0.0f, 0.0f};
  const auto at = [](double v) { return static_cast<int>(std::lround(v * kScale)); };
  for (const PlotLine& line : plot.lines)
    for (int dx = 0; dx < kScale; ++dx)
      for (int dy = 0; dy < kScale; ++dy)
        ImageBufAlgo::render_line(large, at(line.x0) + dx, at(line.y0) + dy, at(line.x1) + dx, at(line.y1) + dy,
                                  line.kind == PlotLine::front    ? red
                                  : line.kind == PlotLine::leader ? leader
                                                                  : grid);
  const int radius = static_cast<int>(PlotLayout::dot) * kScale;
  for (const PlotDot& dot : plot.dots)
    for (int y = -radius; y <= radius; ++y) {
      const int reach = static_cast<int>(std::sqrt(static_cast<double>(radius * radius - y * y)));
      ImageBufAlgo::render_line(large, at(dot.x) - reach, at(dot.y) + y, at(dot.x) + reach, at(dot.y) + y,
                                dot.front ? red : blue);
    }
  bool labelled = true;
  for (const PlotText& text : plot.texts) {
    if (text.upright) {
      // Written across, then turned.
      const int length = at(plot.bottom - PlotLayout::top), thick = at(1.5 * PlotLayout::textSize);
      ImageBuf label(ImageSpec(length, thick, 3, TypeDesc::FLOAT));
      ImageBufAlgo::fill(label, {1.0f, 1.0f, 1.0f});
      labelled = ImageBufAlgo::render_text(label, length / 2, at(PlotLayout::textSize), text.text,
                                           static_cast<int>(PlotLayout::textSize) * kScale, kFont, black,
                                           ImageBufAlgo::TextAlignX::Center) &&
                 labelled;
      ImageBufAlgo::paste(large, at(text.x - PlotLayout::textSize), at(text.y) - length / 2, 0, 0,
                          ImageBufAlgo::rotate270(label));
      continue;
    }
    const auto align = text.anchor < 0   ? ImageBufAlgo::TextAlignX::Left
                       : text.anchor > 0 ? ImageBufAlgo::TextAlignX::Right
                                         : ImageBufAlgo::TextAlignX::Center;
    labelled = ImageBufAlgo::render_text(large, at(text.x), at(text.y), text.text,
                                         static_cast<int>(PlotLayout::textSize) * kScale, kFont, black, align) &&
               labelled;
  }
  const ImageBuf small = ImageBufAlgo::resize(large, "", 0, ROI(0, plot.width, 0, plot.height, 0, 1, 0, 3));
  AtomicFile file(path);
  if (!small.write(file.temporary(), TypeDesc::UINT8, "png"))
    throw ResourceError(fmt::format("{}: cannot be written: {}", path, small.geterror()));
  file.commit();
  return labelled;
}

}  // namespace
}  // namespace pellucid

extern "C" [[gnu::visibility("default")]] pellucid::PlotPngWriter* pellucidPlotPngWriter() {
  return &pellucid::writePng;
}
