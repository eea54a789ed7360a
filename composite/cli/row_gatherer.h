// Fragment lists to the rows of a deep file.
#pragma once
#include <vector>

#include "gbuffer/deep_io.h"
#include "gbuffer/fragments.h"

namespace pellucid::cli {

// Lists come in windows that need not be as wide as the picture; a deep file wants whole rows. Keeps windows until the
// rows they begin are whole.
class RowGatherer {
 public:
  //   metresPerUnit  of the file's depths
  RowGatherer(const Window& data, double metresPerUnit, DeepWriter& writer)
      : data_(data), unitsPerMetre_(1.0 / metresPerUnit), writer_(writer), next_(data.y0) {}
  void add(const FragmentLists& lists);

 private:
  bool covered(int y) const;
  void put(DeepRows& rows, const Fragment& fragment) const;
  void putPixel(DeepRows& rows, const FragmentLists& lists, int x, int y);
  void write(int y0, int y1);

  Window data_;
  double unitsPerMetre_;
  DeepWriter& writer_;
  int next_;
  std::vector<FragmentLists> held_;
  std::vector<const Fragment*> sorted_;
};

}  // namespace pellucid::cli
