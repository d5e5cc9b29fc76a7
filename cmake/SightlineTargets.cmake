# How every library, tool and test of the project is made.

# A library target sightline_NAME (alias sightline::NAME); folders add their files to it.
function(sightline_library name)
  add_library(sightline_${name} STATIC)
  add_library(sightline::${name} ALIAS sightline_${name})
  set_target_properties(sightline_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(sightline_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  sightline_settings(sightline_${name})
endfunction()

# Settings that hold for every target: the language, the warnings, and arithmetic that is the same everywhere.
function(sightline_settings target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -ffp-contract=off
    $<$<BOOL:${SIGHTLINE_WERROR}>:-Werror>)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)")
    # NEON alone, which they all have: vectors of unknown length (SVE) cannot be members, and where the set is chosen at
    # run time GCC cannot make structs of vectors. Highway takes this as a word for "do not choose at run time".
    target_compile_definitions(${target} PRIVATE TOOLCHAIN_MISS_SYS_AUXV_H)
  endif()
  if(SIGHTLINE_SANITIZE)
    # The check of virtual tables needs type information, which what a game links is built without.
    target_compile_options(${target} PRIVATE -fsanitize=${SIGHTLINE_SANITIZE} -fno-omit-frame-pointer
      -fno-sanitize-recover=all -fno-sanitize=vptr)
    target_link_options(${target} PUBLIC -fsanitize=${SIGHTLINE_SANITIZE})
  endif()
  if(SIGHTLINE_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

# Adds the files of the current folder to sightline_TARGET.
function(sightline_sources target)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE files)
  target_sources(sightline_${target} PRIVATE ${files})
endfunction()
