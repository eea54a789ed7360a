# Every room is built with these. Contraction is off so that CPU and GL can agree bit for bit.
add_library(pellucid_options INTERFACE)
# Errors for those who work on the code; whoever builds it may have a compiler that warns of more.
option(PELLUCID_WERROR "Warnings are errors" OFF)
if(PELLUCID_WERROR)
  set(warnings "-Wall;-Wextra;-Wpedantic;-Wshadow;-Werror;-Werror=double-promotion;-Werror=float-conversion")
else()
  set(warnings "-Wall;-Wextra;-Wpedantic;-Wshadow;-Wdouble-promotion;-Wfloat-conversion")
endif()
target_compile_options(pellucid_options INTERFACE "$<BUILD_INTERFACE:${warnings}>" -ffp-contract=off -fno-fast-math)
target_compile_features(pellucid_options INTERFACE cxx_std_20)
target_include_directories(pellucid_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/pellucid-rooms>)

option(PELLUCID_SANITIZE "Address and undefined-behaviour sanitizers" OFF)
if(PELLUCID_SANITIZE)
  # GCC 12 takes std::regex for uninitialised under the sanitizers; the plain build keeps the warning.
  target_compile_options(pellucid_options INTERFACE -Wno-maybe-uninitialized)
  target_compile_options(pellucid_options INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  target_link_options(pellucid_options INTERFACE -fsanitize=address,undefined)
endif()

option(PELLUCID_TSAN "Thread sanitizer, with std::thread in the place of oneTBB (cmake/tsan)" OFF)
if(PELLUCID_TSAN)
  target_compile_options(pellucid_options INTERFACE -fsanitize=thread -fno-omit-frame-pointer -Wno-maybe-uninitialized -Wno-tsan)
  target_link_options(pellucid_options INTERFACE -fsanitize=thread)
  # Before every target, but for the part that includes OpenVDB, which needs the real library.
  include_directories(BEFORE ${PROJECT_SOURCE_DIR}/cmake/tsan)
endif()
