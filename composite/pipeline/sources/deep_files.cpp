// Deep EXR files as transparent layers. Their samples are filtered already, so a pass's place in the pixel does not
// move them, and they are compared with the depth of its centre.
#include <algorithm>

#include "composite/pipeline/layer_source.h"

namespace pellucid {
namespace {

// A sample is held as up to 16 floats, then once more as a fragment.
constexpr std::uint64_t kBytesASample = 64 + sizeof(Fragment);

class DeepFiles : public LayerSource {
 public:
  explicit DeepFiles(std::span<const std::unique_ptr<DeepSource>> files) : files_(files) {}
  const char* name() const override { return "deep files"; }
  bool wantsRows() const override { return true; }  // files are read by rows
  bool mayScatter() const override {
    return std::any_of(files_.begin(), files_.end(), [](const auto& file) { return file->mayScatter(); });
  }
  ListSink into(const SourceView& view, ListSink next) override {
    const std::uint64_t most = std::max<std::uint64_t>(view.settings.budgetBytes / kBytesASample, 1);
    return [this, &gbuffer = *view.picture.centres, rule = view.rule, most, next = std::move(next)](
               const FragmentLists& lists) { mergeDeep(lists, files_, gbuffer, rule, most, next); };
  }

 private:
  std::span<const std::unique_ptr<DeepSource>> files_;
};

}  // namespace

std::unique_ptr<LayerSource> deepFiles(std::span<const std::unique_ptr<DeepSource>> files) {
  return std::make_unique<DeepFiles>(files);
}

}  // namespace pellucid
