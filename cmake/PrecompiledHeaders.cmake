# What nearly every file includes from outside is parsed once for the rooms and once for the tests. Each file still names
# all that it uses: -DPELLUCID_PCH=OFF builds without, and headers.CompileAlone never sees these.
option(PELLUCID_PCH "Parse the outside headers once" ON)
set(PELLUCID_COMMON_HEADERS <fmt/format.h> <glm/glm.hpp> <algorithm> <array> <cmath> <cstdint> <functional> <limits>
  <map> <memory> <optional> <string> <tuple> <utility> <vector>)

# pellucid_precompiled(TARGET FROM HEADERS...): TARGET takes the headers parsed for FROM, which may be itself.
function(pellucid_precompiled target from)
  if(NOT PELLUCID_PCH)
    return()
  endif()
  if(target STREQUAL from)
    target_precompile_headers(${target} PRIVATE ${PELLUCID_COMMON_HEADERS} ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${from})
  endif()
endfunction()
