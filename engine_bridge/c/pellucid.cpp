// The C boundary: null pointers, versions, contexts, threads and exceptions stop here.
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <new>

#include "engine_bridge/c/frame_numbers.h"
#include "engine_bridge/c/pass.h"
#include "engine_bridge/c/pass_choices.h"
#include "shaders/weights.h"

namespace {

using pellucid::c::kEveryFeature;
using pellucid::c::nameUnknownChoice;

// One call at a time with a pass, on the thread where its context is current.
template <class F>
pld_status guarded(pld_pass* pass, const char* call, F f) noexcept {
  if (!pass) return PLD_ERROR_ARGUMENT;
  if (pass->busy.test_and_set(std::memory_order_acquire)) return PLD_ERROR_BUSY;
  pld_status status = PLD_OK;
  try {
    pass->device.message[0] = '\0';
    status = pass->device.isCurrent()
                 ? f()
                 : pass->device.fail(PLD_ERROR_CONTEXT, "%s: the context of pld_create() is not current on this thread",
                                     call);
  } catch (const std::bad_alloc&) {
    status = pass->device.fail(PLD_ERROR_MEMORY, "%s: out of memory", call);
  } catch (const std::exception& mistake) {
    status = pass->device.fail(PLD_ERROR_INTERNAL, "%s: %s", call, mistake.what());
  } catch (...) {
    status = PLD_ERROR_INTERNAL;
  }
  pass->busy.clear(std::memory_order_release);
  return status;
}

// For a host without a log too.
void keep(const pld_create_info& info, const char* text) {
  if (info.message && info.message_size > 0) std::snprintf(info.message, info.message_size, "%s", text);
}

pld_status refuse(const pld_create_info& info, pld_status status, const char* text) {
  keep(info, text);
  if (info.log) info.log(info.log_user, PLD_LOG_ERROR, text);
  return status;
}

// Before 0.4 it ended before fragments_per_pixel, in 0.4 before message.
pld_status wholeInfo(const pld_create_info& info, pld_create_info& whole) {
  if (info.struct_size != offsetof(pld_create_info, fragments_per_pixel) &&
      info.struct_size != offsetof(pld_create_info, message) && info.struct_size != sizeof(pld_create_info))
    return PLD_ERROR_VERSION;  // its log may lie elsewhere
  std::memcpy(&whole, &info, info.struct_size);
  return PLD_OK;
}

pld_status checkInfo(const pld_create_info& info) {
  char text[200];
  // Structures that have grown since keep the size by which they are known.
  if (info.version >> 20 != PLD_VERSION_MAJOR || ((info.version >> 10) & 1023u) > PLD_VERSION_MINOR) {
    std::snprintf(text, sizeof(text), "pld_create: version: found %u.%u, expected %d.0 to %d.%d", info.version >> 20,
                  (info.version >> 10) & 1023u, PLD_VERSION_MAJOR, PLD_VERSION_MAJOR, PLD_VERSION_MINOR);
    return refuse(info, PLD_ERROR_VERSION, text);
  }
  if (!info.get_proc_address) return refuse(info, PLD_ERROR_ARGUMENT, "pld_create: get_proc_address is null");
  if (nameUnknownChoice(info, "pld_create", text)) return refuse(info, PLD_ERROR_ARGUMENT, text);
  constexpr uint32_t flags = PLD_FLAG_HOST_RESTORES | PLD_FLAG_TIMERS | PLD_FLAG_DEBUG_GROUPS | PLD_FLAG_DEBUG_VIEWS |
                             PLD_FLAG_VALIDATE | PLD_FLAG_TRUST_TEXTURES;
  if ((info.features & ~kEveryFeature) || (info.flags & ~flags))
    return refuse(info, PLD_ERROR_ARGUMENT, "pld_create: features or flags hold a bit that this version does not have");
  return PLD_OK;
}

pld_status wholeFrame(pld_pass* pass, const char* call, const pld_frame& frame, pld_frame& whole) {
  if (pellucid::c::takeWhole(frame, whole)) return PLD_OK;
  return pass->device.fail(PLD_ERROR_VERSION, "%s: frame.struct_size: found %u, expected %zu", call, frame.struct_size,
                           sizeof(pld_frame));
}

// Of 0.3 it ended before shadow_face.
pld_status wholeTarget(pld_pass* pass, const pld_target& target, pld_target& whole) {
  if (target.struct_size != offsetof(pld_target, shadow_face) && target.struct_size != sizeof(pld_target))
    return pass->device.fail(PLD_ERROR_VERSION, "pld_resolve: target.struct_size: found %u, expected %zu",
                             target.struct_size, sizeof(pld_target));
  std::memcpy(&whole, &target, target.struct_size);
  return PLD_OK;
}

}  // namespace

extern "C" {

uint32_t pld_version(void) {
  return PLD_VERSION;
}

pld_status pld_weight_named(const char* name, pld_weight* weight) {
  if (!name || !weight) return PLD_ERROR_ARGUMENT;
  for (const pellucid::DepthWeight& row : pellucid::kDepthWeights)
    if (std::strcmp(name, row.name) == 0) {
      *weight = static_cast<pld_weight>(row.kind);
      return PLD_OK;
    }
  return PLD_ERROR_ARGUMENT;
}

pld_status pld_create(const pld_create_info* info, pld_pass** pass) {
  if (!pass) return PLD_ERROR_ARGUMENT;
  *pass = nullptr;
  if (!info) return PLD_ERROR_ARGUMENT;
  pld_create_info whole{};
  if (const pld_status status = wholeInfo(*info, whole); status != PLD_OK) return status;
  keep(whole, "");
  if (const pld_status status = checkInfo(whole); status != PLD_OK) return status;
  pld_pass* made = nullptr;
  pld_status status = PLD_ERROR_MEMORY;
  try {
    made = new pld_pass;
    status = made->create(whole);
  } catch (const std::bad_alloc&) {
    status = refuse(whole, PLD_ERROR_MEMORY, "pld_create: out of memory");
  } catch (const std::exception& mistake) {
    status = refuse(whole, PLD_ERROR_INTERNAL, mistake.what());
  } catch (...) {
    status = PLD_ERROR_INTERNAL;
  }
  if (status == PLD_OK)
    *pass = made;
  else if (made) {
    if (made->device.message[0]) keep(whole, made->device.message);
    made->destroyObjects();
    delete made;
  }
  return status;
}

pld_status pld_resize(pld_pass* pass, int32_t width, int32_t height) {
  return guarded(pass, "pld_resize", [&] { return pass->resize(width, height); });
}

pld_status pld_fix(pld_pass* pass, const pld_frame* frame, uint32_t fields) {
  return guarded(pass, "pld_fix", [&] {
    if (!frame) return pass->device.fail(PLD_ERROR_ARGUMENT, "pld_fix: frame is null");
    pld_frame whole{};
    const pld_status status = wholeFrame(pass, "pld_fix", *frame, whole);
    return status == PLD_OK ? pass->fix(whole, fields) : status;
  });
}

pld_status pld_begin(pld_pass* pass, pld_stage stage, const pld_frame* frame) {
  return guarded(pass, "pld_begin", [&] {
    if (!frame) return pass->device.fail(PLD_ERROR_ARGUMENT, "pld_begin: frame is null");
    pld_frame whole{};
    const pld_status status = wholeFrame(pass, "pld_begin", *frame, whole);
    return status == PLD_OK ? pass->begin(stage, whole) : status;
  });
}

pld_status pld_end(pld_pass* pass) {
  return guarded(pass, "pld_end", [&] { return pass->end(); });
}

pld_status pld_resolve(pld_pass* pass, const pld_target* target) {
  return guarded(pass, "pld_resolve", [&] {
    if (!target) return pass->device.fail(PLD_ERROR_ARGUMENT, "pld_resolve: target is null");
    pld_target whole{};
    const pld_status status = wholeTarget(pass, *target, whole);
    return status == PLD_OK ? pass->resolve(whole) : status;
  });
}

pld_status pld_query(pld_pass* pass, pld_value what, uint64_t* value) {
  return guarded(pass, "pld_query", [&] {
    return value ? pass->query(what, *value) : pass->device.fail(PLD_ERROR_ARGUMENT, "pld_query: value is null");
  });
}

pld_status pld_glsl(pld_pass* pass, pld_stage stage, int32_t version, const char** text) {
  return guarded(pass, "pld_glsl", [&] {
    return text ? pass->texts().seam(stage, version, *text)
                : pass->device.fail(PLD_ERROR_ARGUMENT, "pld_glsl: text is null");
  });
}

pld_status pld_connect(pld_pass* pass, uint32_t program) {
  return guarded(pass, "pld_connect", [&] { return pass->texts().connect(program); });
}

pld_status pld_shadow_resize(pld_pass* pass, const pld_shadow_info* info) {
  return guarded(pass, "pld_shadow_resize", [&] { return pass->shadowResize(info); });
}

pld_status pld_shadow_begin(pld_pass* pass, const pld_shadow_view* view) {
  return guarded(pass, "pld_shadow_begin", [&] {
    return view ? pass->shadowBegin(*view) : pass->device.fail(PLD_ERROR_ARGUMENT, "pld_shadow_begin: view is null");
  });
}

pld_status pld_shadow_end(pld_pass* pass) {
  return guarded(pass, "pld_shadow_end", [&] { return pass->shadowEnd(); });
}

pld_status pld_shadow_glsl(pld_pass* pass, pld_shadow_text which, int32_t version, const char** text) {
  return guarded(pass, "pld_shadow_glsl", [&] {
    return text ? pass->texts().shadows(which, version, *text)
                : pass->device.fail(PLD_ERROR_ARGUMENT, "pld_shadow_glsl: text is null");
  });
}

pld_status pld_destroy(pld_pass** pass) {
  if (!pass || !*pass) return PLD_ERROR_ARGUMENT;
  const pld_status status = guarded(*pass, "pld_destroy", [&] {
    (*pass)->destroyObjects();
    return PLD_OK;
  });
  if (status == PLD_ERROR_BUSY) return status;
  delete *pass;
  *pass = nullptr;
  return status;
}

const char* pld_message(const pld_pass* pass) {
  return pass ? pass->device.message : "";
}

const char* pld_status_name(pld_status status) {
  static const char* const names[] = {"PLD_OK",           "PLD_ERROR_ARGUMENT", "PLD_ERROR_VERSION",
                                      "PLD_ERROR_ORDER",  "PLD_ERROR_SIZE",     "PLD_ERROR_TEXTURE",
                                      "PLD_ERROR_FORMAT", "PLD_ERROR_CONTEXT",  "PLD_ERROR_UNSUPPORTED",
                                      "PLD_ERROR_MEMORY", "PLD_ERROR_BUSY",     "PLD_ERROR_INTERNAL",
                                      "PLD_ERROR_MISUSE"};
  return status >= PLD_OK && status <= PLD_ERROR_MISUSE ? names[status] : "no pld_status";
}

}  // extern "C"
