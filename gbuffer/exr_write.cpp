#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDeepScanLineInputPart.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfDeepTiledInputPart.h>
#include <OpenEXR/ImfDeepTiledOutputPart.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <new>
#include <stdexcept>

#include "gbuffer/atomic_file.h"
#include "gbuffer/errors.h"
#include "gbuffer/exr_header.h"
#include "gbuffer/exr_stream.h"

namespace pellucid {
namespace {

bool changesPixels(const ExrPartEdit& edit) {
  return !edit.replaced.empty() || !edit.added.empty();
}

// Whether coding again loses something. B44 and DWA are not even stable on their own output. PXR24 rounds floats to 24
// bits, which leaves floats that it has rounded before alone, but not what we write; half and uint it keeps.
bool losesBits(const ExrPart& part, const ExrPartEdit& edit) {
  if (part.compression.starts_with("b44") || part.compression.starts_with("dwa")) return true;
  if (part.compression != "pxr24") return false;
  for (const auto& [name, bytes] : edit.replaced)
    if (part.find(name)->type == PixelType::float32) return true;
  for (const ExrChannel& channel : edit.added)
    if (channel.type == PixelType::float32) return true;
  return false;
}

// OpenEXR's Header::erase forgets to free what it erases.
exr::Header without(const exr::Header& header, const std::string& attribute) {
  exr::Header rest;
  for (auto it = header.begin(); it != header.end(); ++it)
    if (it.name() != attribute) rest.insert(it.name(), it.attribute());
  return rest;
}

exr::Header editedHeader(const ExrPart& part, const ExrPartEdit& edit, std::vector<std::string>& notes) {
  exr::Header header = part.header->header;
  for (const auto& [name, text] : edit.attributes) {
    const auto old = part.attributes.find(name);
    if (old != part.attributes.end() && old->second.type != "string") header = without(header, name);
    header.insert(name, exr::StringAttribute(text));
  }
  for (const ExrChannel& channel : edit.added)
    header.channels().insert(channel.name, exr::Channel(exrType(channel.type)));
  if (changesPixels(edit) && losesBits(part, edit)) {
    header.compression() = exr::ZIP_COMPRESSION;
    notes.push_back(fmt::format("{}{} compression became zip: coding again would change what was not touched",
                                part.name.empty() ? "" : "part " + part.name + ": ", part.compression));
  }
  return header;
}

exr::FrameBuffer frameOf(const ExrPart& part, const ExrPartEdit& edit) {
  exr::FrameBuffer frame;
  for (const ExrChannel& channel : part.channels) {
    const auto replaced = edit.replaced.find(channel.name);
    const std::vector<std::byte>& bytes = replaced == edit.replaced.end() ? channel.bytes : replaced->second;
    if (bytes.size() != channel.bytes.size()) throw std::logic_error("an edit of another size than its channel");
    insertSlice(frame, channel.name, channel.type, bytes.data(), part.data);
  }
  const std::size_t pixels = static_cast<std::size_t>(part.data.width()) * static_cast<std::size_t>(part.data.height());
  for (const ExrChannel& channel : edit.added) {
    if (channel.bytes.size() != pixels * bytesOf(channel.type))
      throw std::logic_error("an added channel of another size than its part");
    insertSlice(frame, channel.name, channel.type, channel.bytes.data(), part.data);
  }
  return frame;
}

template <class Output>
void writeTiles(Output& out, const exr::FrameBuffer& frame) {
  out.setFrameBuffer(frame);
  out.writeTiles(0, out.numXTiles(0) - 1, 0, out.numYTiles(0) - 1, 0);
}

template <class Output>
void writeLines(Output& out, const exr::FrameBuffer& frame, const Window& data) {
  out.setFrameBuffer(frame);
  out.writePixels(data.height());
}

// Single-part files without the multi-part bit, so that no attribute appears that was not there.
void writeSinglePart(ExrSink& sink, exr::MultiPartInputFile& file, const ExrPart& part, const ExrPartEdit& edit,
                     exr::Header header) {
  if (!part.header->hadType) header = without(header, "type");
  if (part.tiled) {
    exr::TiledOutputFile out(sink, header, exrThreads());
    if (changesPixels(edit)) {
      writeTiles(out, frameOf(part, edit));
    } else {
      exr::TiledInputPart in(file, 0);
      out.copyPixels(in);
    }
  } else {
    exr::OutputFile out(sink, header, exrThreads());
    if (changesPixels(edit)) {
      writeLines(out, frameOf(part, edit), part.data);
    } else {
      exr::InputPart in(file, 0);
      out.copyPixels(in);
    }
  }
}

template <class Input, class Output>
void copyPart(exr::MultiPartInputFile& file, exr::MultiPartOutputFile& to, int index) {
  Input in(file, index);
  Output out(to, index);
  out.copyPixels(in);
}

void writePart(exr::MultiPartOutputFile& to, exr::MultiPartInputFile& file, int index, const ExrPart& part,
               const ExrPartEdit& edit) {
  if (changesPixels(edit) && part.tiled) {
    exr::TiledOutputPart out(to, index);
    writeTiles(out, frameOf(part, edit));
  } else if (changesPixels(edit)) {
    exr::OutputPart out(to, index);
    writeLines(out, frameOf(part, edit), part.data);
  } else if (part.deep && part.tiled) {
    copyPart<exr::DeepTiledInputPart, exr::DeepTiledOutputPart>(file, to, index);
  } else if (part.deep) {
    copyPart<exr::DeepScanLineInputPart, exr::DeepScanLineOutputPart>(file, to, index);
  } else if (part.tiled) {
    copyPart<exr::TiledInputPart, exr::TiledOutputPart>(file, to, index);
  } else {
    copyPart<exr::InputPart, exr::OutputPart>(file, to, index);
  }
}

void checkEdit(const ExrDocument& document, int index, const ExrPartEdit& edit) {
  const ExrPart& part = document.parts.at(static_cast<std::size_t>(index));
  if (!changesPixels(edit)) return;
  if (part.deep) throw std::logic_error("an edit of a deep part");
  if (part.levelMode != 0)
    throw InputError(fmt::format("{}: {}: found a {} map, expected one level: the smaller ones would go stale",
                                 document.path, part.name.empty() ? "the image" : "part " + part.name,
                                 part.levelMode == 1 ? "mip" : "rip"));
  for (const auto& [name, bytes] : edit.replaced)
    if (!part.find(name)) throw std::logic_error("an edit of a channel that is not there");
  for (const ExrChannel& channel : edit.added)
    if (part.find(channel.name))
      throw MeaningError(
          fmt::format("{}: channel {} is to be added, but the file has one already", document.path, channel.name));
}

// Runs the OpenEXR calls of a write; what they throw means that coding failed, what the sink kept that the disk did.
template <class Work>
void writeAtomically(const std::string& path, Work&& work) {
  AtomicFile file(path);
  ExrSink sink(file.temporary(), path);
  try {
    work(sink);
  } catch (const Error&) {
    throw;
  } catch (const std::logic_error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw ResourceError(path + ": cannot be written: memory ran out");
  } catch (const std::exception& error) {
    sink.finish();
    throw ResourceError(fmt::format("{}: cannot be written: {}", path, error.what()));
  }
  sink.finish();
  file.commit();
}

}  // namespace

std::vector<std::string> writeExr(const std::string& path, const ExrDocument& document,
                                  const std::map<int, ExrPartEdit>& edits) {
  const ExrPartEdit nothing;
  std::vector<const ExrPartEdit*> editOf;
  std::vector<exr::Header> headers;
  std::vector<std::string> notes;
  for (int i = 0; i < static_cast<int>(document.ownParts); ++i) {
    const auto found = edits.find(i);
    editOf.push_back(found == edits.end() ? &nothing : &found->second);
    checkEdit(document, i, *editOf.back());
    headers.push_back(editedHeader(document.parts[static_cast<std::size_t>(i)], *editOf.back(), notes));
  }
  const auto copyOrCode = [&](ExrSink& sink) {
    ExrSource stream(*document.source);
    exr::MultiPartInputFile file(stream, exrThreads(), false);
    if (!document.multiPart && !document.parts[0].deep) {
      writeSinglePart(sink, file, document.parts[0], *editOf[0], headers[0]);
      return;
    }
    exr::MultiPartOutputFile out(sink, headers.data(), static_cast<int>(headers.size()), false, exrThreads());
    for (std::size_t i = 0; i < document.ownParts; ++i)
      writePart(out, file, static_cast<int>(i), document.parts[i], *editOf[i]);
  };
  writeAtomically(path, [&](ExrSink& sink) {
    const auto expectUnchanged = [&] {
      if (document.source->changed())
        throw InputError(document.path + ": has changed since it was read, expected to copy parts from it");
    };
    expectUnchanged();
    copyOrCode(sink);
    expectUnchanged();
  });
  return notes;
}

namespace {

// What a header says of how and where its pixels are stored, which another file has its own of.
constexpr const char* kStorage[] = {"channels",           "compression", "dataWindow",     "displayWindow",
                                    "lineOrder",          "tiles",       "type",           "version",
                                    "chunkCount",         "name",        "view",           "multiView",
                                    "maxSamplesPerPixel", "preview",     "deepImageState", "dwaCompressionLevel"};

void copyAttributes(const ExrPart& from, exr::Header& to) {
  for (auto it = from.header->header.begin(); it != from.header->header.end(); ++it)
    if (std::none_of(std::begin(kStorage), std::end(kStorage),
                     [&](const char* name) { return it.name() == std::string(name); }))
      to.insert(it.name(), it.attribute());
}

// The header and the memory of one new part.
struct NewPart {
  exr::Header header;
  exr::FrameBuffer frame;

  explicit NewPart(const NewExr& file)
      : header(boxOf(file.display), boxOf(file.data), static_cast<float>(file.pixelAspect)) {
    if (file.like) copyAttributes(*file.like, header);
    header.compression() = exr::ZIP_COMPRESSION;
    if (!file.part.empty()) header.setName(file.part);
    for (const auto& [name, text] : file.attributes) put(name, exr::StringAttribute(text));
    for (const auto& [name, numbers] : file.matrices) {
      IMATH_NAMESPACE::M44f matrix;
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
          matrix[row][column] = numbers.at(static_cast<std::size_t>(row * 4 + column));
      put(name, exr::M44fAttribute(matrix));
    }
    if (const std::vector<float>& xy = file.chromaticities; xy.size() == 8)
      put("chromaticities", exr::ChromaticitiesAttribute(
                                exr::Chromaticities({xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]})));
    const std::size_t pixels =
        static_cast<std::size_t>(file.data.width()) * static_cast<std::size_t>(file.data.height());
    for (const ExrChannel& channel : file.channels) {
      if (header.channels().findChannel(channel.name)) throw std::logic_error("two channels named " + channel.name);
      if (channel.bytes.size() != pixels * bytesOf(channel.type)) throw std::logic_error(channel.name + ": wrong size");
      header.channels().insert(channel.name, exr::Channel(exrType(channel.type)));
      insertSlice(frame, channel.name, channel.type, channel.bytes.data(), file.data);
    }
  }

 private:
  // An attribute of another type under that name goes.
  void put(const std::string& name, const exr::Attribute& attribute) {
    const bool another =
        header.find(name) != header.end() && std::string(header[name].typeName()) != attribute.typeName();
    if (another) header = without(header, name);
    header.insert(name, attribute);
  }
};

}  // namespace

void writeNewExr(const std::string& path, const NewExr& file) {
  const NewPart part(file);
  writeAtomically(path, [&](ExrSink& sink) {
    exr::OutputFile out(sink, part.header, exrThreads());
    writeLines(out, part.frame, file.data);
  });
}

void writeNewExr(const std::string& path, const std::vector<NewExr>& files) {
  std::vector<NewPart> parts(files.begin(), files.end());
  std::vector<exr::Header> headers;
  for (NewPart& part : parts) {
    part.header.setType(exr::SCANLINEIMAGE);
    headers.push_back(part.header);
  }
  writeAtomically(path, [&](ExrSink& sink) {
    exr::MultiPartOutputFile out(sink, headers.data(), static_cast<int>(headers.size()), false, exrThreads());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      exr::OutputPart part(out, static_cast<int>(i));
      writeLines(part, parts[i].frame, files[i].data);
    }
  });
}

}  // namespace pellucid
