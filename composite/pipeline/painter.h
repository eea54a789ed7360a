// Painters: each turns one jittered pass into a veil, a file in painters/ for each kind.
#pragma once
#include <memory>

#include "composite/pipeline/device.h"
#include "composite/pipeline/layer_source.h"
#include "composite/pipeline/result.h"

namespace pellucid {

// What a painter works with. All of it outlives the painter.
struct PaintContext {
  const Plan& plan;
  const Shot& shot;
  const LitPicture& picture;
  const LayerSources& sources;
  Device& device;
  Journal& journal;
  RunCounts& counts;
};

class Painter {
 public:
  virtual ~Painter() = default;
  // One pass.
  //   sample  with the light, and its place in the pixel
  //   pass    its number
  virtual Veil paint(const PassSettings& sample, int pass) = 0;
  // Whether paint() has left it to showBackground() what the pass's layers show of the background.
  virtual bool showsLater() const { return false; }
  //   rows  of the veil, as rowsOf() cuts them
  virtual void showBackground(Veil& rows) { (void)rows; }
  // After all passes: false where they do not hold together, and are all to be painted again.
  virtual bool settled() { return true; }
  // Adds to the mean of the passes what only all of them together can tell.
  virtual void finish(Veil& mean) { (void)mean; }
};

std::unique_ptr<Painter> makePainter(const PaintContext& context);

// Of painters/.
std::unique_ptr<Painter> sumsPainter(const PaintContext& context);
std::unique_ptr<Painter> sortedPainter(const PaintContext& context);
std::unique_ptr<Painter> listedPainter(const PaintContext& context);
std::unique_ptr<Painter> samplesPainter(const PaintContext& context);
std::unique_ptr<Painter> deviceSamplesPainter(const PaintContext& context);
std::unique_ptr<Painter> withinPainter(const PaintContext& context);
std::unique_ptr<Painter> systemsPainter(const PaintContext& context);

}  // namespace pellucid
