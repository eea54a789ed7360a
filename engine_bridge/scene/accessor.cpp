#include "engine_bridge/scene/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace pellucid::gltf {

static_assert(std::endian::native == std::endian::little, "buffers are little endian and copied as they are");

namespace {

// An accessor without a buffer view is zeros: its count is checked against nothing else.
constexpr std::size_t kMostZeros = std::size_t{1} << 22;
constexpr std::size_t kMostElements = 0xffffffffu;  // 32-bit indices
constexpr std::size_t kMostStride = 252;            // glTF 2.0, bufferView.byteStride

enum Component : std::size_t {
  kByte = 5120,
  kUByte = 5121,
  kShort = 5122,
  kUShort = 5123,
  kUInt = 5125,
  kFloat = 5126
};

// 0 for what is no component type.
std::size_t componentBytes(std::size_t type) {
  switch (type) {
    case kByte:
    case kUByte:
      return 1;
    case kShort:
    case kUShort:
      return 2;
    case kUInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

std::size_t componentSize(const JsonView& type) {
  const std::size_t size = componentBytes(type.unsignedInteger());
  if (size == 0)
    type.refuse(fmt::format("is {}; expected 5120, 5121, 5122, 5123, 5125 or 5126", type.unsignedInteger()));
  return size;
}

std::size_t typeWidth(const JsonView& type) {
  const std::string& name = type.string();
  if (name == "SCALAR") return 1;
  if (name == "VEC2") return 2;
  if (name == "VEC3") return 3;
  if (name == "VEC4") return 4;
  if (name == "MAT4") return 16;
  type.refuse(fmt::format("is {}; expected SCALAR, VEC2, VEC3, VEC4 or MAT4", name));
}

// Elements in a buffer view, `stride` bytes apart.
struct Layout {
  SharedBytes bytes;
  std::size_t stride = 0;
  const std::uint8_t* element(std::size_t i) const { return bytes.bytes().data() + i * stride; }
};

//   holder  the object with bufferView and byteOffset: an accessor, or a part of its `sparse`
Layout checkedLayout(GltfFile& file, const JsonView& holder, std::size_t count, std::size_t elementSize,
                     bool mayStride) {
  const JsonView view = file.item("bufferViews", holder.at("bufferView"));
  const std::size_t offset = holder.unsignedInteger("byteOffset", 0);
  Layout layout{file.viewBytes(view), elementSize};
  if (const std::optional<JsonView> stride = mayStride ? view.find("byteStride") : std::nullopt) {
    layout.stride = stride->unsignedInteger();
    if (layout.stride == 0) layout.stride = elementSize;  // glTF 1.0's word for packed, still written by some
    if (layout.stride < elementSize || layout.stride > kMostStride) {
      stride->refuse(fmt::format("is {}; expected {} to {}", layout.stride, elementSize, kMostStride));
    }
  }
  const std::size_t available = layout.bytes.size();
  // No overflow: count < 2^32 and stride < 2^8.
  const std::size_t needed = (count - 1) * layout.stride + elementSize;
  if (offset > available || needed > available - offset) {
    holder.refuse(fmt::format("reads {} bytes from byte {}; {} has {}", needed, offset, view.where(), available));
  }
  layout.bytes = layout.bytes.part(offset, needed);
  return layout;
}

std::size_t checkedCount(const JsonView& accessor) {
  const JsonView member = accessor.at("count");
  const std::size_t count = member.unsignedInteger();
  if (count < 1 || count > kMostElements) member.refuse(fmt::format("is {}; expected 1 to {}", count, kMostElements));
  if (!accessor.find("bufferView") && count > kMostZeros) {
    member.refuse(fmt::format("is {} without a bufferView; expected at most {}", count, kMostZeros));
  }
  return count;
}

template <class T>
T load(const std::uint8_t* bytes) {
  T value;  // memcpy: the file's alignment is not trusted
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

double loadComponent(const std::uint8_t* bytes, std::size_t type) {
  switch (type) {
    case kByte:
      return load<std::int8_t>(bytes);
    case kUByte:
      return *bytes;
    case kShort:
      return load<std::int16_t>(bytes);
    case kUShort:
      return load<std::uint16_t>(bytes);
    default:
      return static_cast<double>(load<float>(bytes));
  }
}

std::uint32_t loadIndex(const std::uint8_t* bytes, std::size_t type) {
  switch (type) {
    case kUByte:
      return *bytes;
    case kUShort:
      return load<std::uint16_t>(bytes);
    default:
      return load<std::uint32_t>(bytes);
  }
}

std::size_t indexType(const JsonView& type) {
  const std::size_t found = type.unsignedInteger();
  if (found != kUByte && found != kUShort && found != kUInt) {
    type.refuse(fmt::format("is {}; expected 5121, 5123 or 5125 for indices", found));
  }
  return found;
}

// Calls store(element, bytes) for every element, the sparse ones last.
template <class Store>
void forEachElement(GltfFile& file, const JsonView& accessor, std::size_t count, std::size_t elementSize,
                    const Store& store) {
  if (accessor.find("bufferView")) {
    const Layout base = checkedLayout(file, accessor, count, elementSize, true);
    for (std::size_t i = 0; i < count; ++i) store(i, base.element(i));
  }
  const std::optional<JsonView> sparse = accessor.find("sparse");
  if (!sparse) return;
  const JsonView member = sparse->at("count");
  const std::size_t changed = member.unsignedInteger();
  if (changed < 1 || changed > count) member.refuse(fmt::format("is {}; expected 1 to {}", changed, count));
  const JsonView where = sparse->at("indices");
  const std::size_t type = indexType(where.at("componentType"));
  const Layout indices = checkedLayout(file, where, changed, componentSize(where.at("componentType")), false);
  const Layout values = checkedLayout(file, sparse->at("values"), changed, elementSize, false);
  for (std::size_t i = 0; i < changed; ++i) {
    const std::size_t element = loadIndex(indices.element(i), type);
    if (element >= count) where.refuse(fmt::format("hold {}; expected indices below {}", element, count));
    store(element, values.element(i));
  }
}

}  // namespace

bool ElementType::integer() const {
  return component != kFloat;
}

float ElementType::valueOf(double value) const {
  const auto plain = static_cast<float>(value);
  if (!normalised) return plain;
  switch (component) {
    case kByte:
      return std::max(plain / 127.0f, -1.0f);
    case kUByte:
      return plain / 255.0f;
    case kShort:
      return std::max(plain / 32767.0f, -1.0f);
    case kUShort:
      return plain / 65535.0f;
    default:
      return plain;
  }
}

ElementType elementType(GltfFile& file, const JsonView& reference, std::initializer_list<std::size_t> widths,
                        Integers integers) {
  const JsonView accessor = file.item("accessors", reference);
  const JsonView typeName = accessor.at("type");
  const JsonView componentType = accessor.at("componentType");
  ElementType type;
  type.width = typeWidth(typeName);
  if (std::find(widths.begin(), widths.end(), type.width) == widths.end()) {
    typeName.refuse(fmt::format("is {}, which {} cannot be", typeName.string(), reference.where()));
  }
  componentSize(componentType);
  type.component = componentType.unsignedInteger();
  type.normalised = accessor.boolean("normalized", false);
  if (integers == Integers::asNormalised && type.integer()) type.normalised = true;
  const bool allowed = integers == Integers::any || (integers != Integers::none && type.normalised);
  if (type.integer() && (type.component == kUInt || !allowed)) {
    constexpr const char* kExpected[] = {"float (5126)", "float (5126) or normalised bytes or shorts",
                                         "float (5126), bytes or shorts", "float (5126), bytes or shorts"};
    componentType.refuse(fmt::format("is {}{}; {} must be {}", type.component, type.normalised ? ", normalised" : "",
                                     reference.where(), kExpected[static_cast<int>(integers)]));
  }
  type.count = checkedCount(accessor);
  return type;
}

Elements readElements(GltfFile& file, const JsonView& reference, std::initializer_list<std::size_t> widths,
                      Integers integers, bool inPlace) {
  const JsonView accessor = file.item("accessors", reference);
  const ElementType type = elementType(file, reference, widths, integers);
  const std::size_t size = componentSize(accessor.at("componentType"));
  Elements elements;
  elements.width = type.width;
  elements.count = type.count;
  const std::size_t elementSize = size * elements.width;
  // Checked before anything is allocated: a huge count is only a number so far.
  if (accessor.find("bufferView")) {
    const Layout layout = checkedLayout(file, accessor, elements.count, elementSize, true);
    if (inPlace && !accessor.find("sparse")) {
      elements.type = type;
      elements.bytes = layout.bytes;
      elements.stride = layout.stride;
      return elements;
    }
  }
  elements.values.assign(elements.count * elements.width, 0.0f);
  forEachElement(file, accessor, elements.count, elementSize, [&](std::size_t i, const std::uint8_t* bytes) {
    for (std::size_t c = 0; c < elements.width; ++c) {
      elements.values[i * elements.width + c] = type.valueOf(loadComponent(bytes + c * size, type.component));
    }
  });
  return elements;
}

namespace {

std::size_t checkedIndices(const JsonView& accessor) {
  indexType(accessor.at("componentType"));
  if (accessor.at("type").string() != "SCALAR") {
    accessor.at("type").refuse(fmt::format("is {}; expected SCALAR for indices", accessor.at("type").string()));
  }
  return checkedCount(accessor);
}

}  // namespace

std::vector<std::uint32_t> readIndices(GltfFile& file, const JsonView& reference) {
  const JsonView accessor = file.item("accessors", reference);
  const std::size_t count = checkedIndices(accessor);
  const JsonView componentType = accessor.at("componentType");
  const std::size_t type = componentType.unsignedInteger();
  const std::size_t size = componentSize(componentType);
  if (accessor.find("bufferView")) checkedLayout(file, accessor, count, size, true);
  std::vector<std::uint32_t> indices(count, 0);
  forEachElement(file, accessor, count, size,
                 [&](std::size_t i, const std::uint8_t* bytes) { indices[i] = loadIndex(bytes, type); });
  return indices;
}

Indices placeIndices(GltfFile& file, const JsonView& reference) {
  const JsonView accessor = file.item("accessors", reference);
  Indices indices;
  if (!accessor.find("bufferView") || accessor.find("sparse")) {
    indices.values = readIndices(file, reference);
    indices.count = indices.values.size();
    return indices;
  }
  indices.count = checkedIndices(accessor);
  indices.component = accessor.at("componentType").unsignedInteger();
  const Layout layout = checkedLayout(file, accessor, indices.count, componentSize(accessor.at("componentType")), true);
  indices.bytes = layout.bytes;
  indices.stride = layout.stride;
  return indices;
}

float Elements::placedAt(std::size_t element, std::size_t component) const {
  const std::uint8_t* at = bytes.bytes().data() + element * stride;
  if (type.component == kFloat) return load<float>(at + component * sizeof(float));
  return type.valueOf(loadComponent(at + component * componentBytes(type.component), type.component));
}

std::uint32_t Indices::placedAt(std::size_t i) const {
  return loadIndex(bytes.bytes().data() + i * stride, component);
}

namespace {

void announceElements(const SharedBytes& bytes, std::size_t stride, std::size_t size, std::size_t first,
                      std::size_t last) {
  if (bytes.file()) bytes.file()->announce(bytes.bytes().subspan(first * stride, (last - first) * stride + size));
}

}  // namespace

void Elements::announce(std::size_t first, std::size_t last) const {
  announceElements(bytes, stride, width * componentBytes(type.component), first, last);
}
void Indices::announce(std::size_t first, std::size_t last) const {
  announceElements(bytes, stride, componentBytes(component), first, last);
}
void Elements::settle() const {
  if (bytes.file()) bytes.file()->settle();
}
void Indices::settle() const {
  if (bytes.file()) bytes.file()->settle();
}
void Elements::requireWhole() const {
  if (bytes.file()) bytes.file()->requireWhole();
}
void Indices::requireWhole() const {
  if (bytes.file()) bytes.file()->requireWhole();
}

}  // namespace pellucid::gltf
