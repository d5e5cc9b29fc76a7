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

# A shared library sightline_NAME (alias sightline::NAME) of an archive of this build, in a file named OUTPUT. Its C functions
# alone are seen from outside; what none of them needs is left out.
function(sightline_shared name output archive)
  add_library(sightline_${name} SHARED $<TARGET_OBJECTS:${archive}>)
  add_library(sightline::${name} ALIAS sightline_${name})
  # Below 1.0 a minor version may change the interface.
  set_target_properties(sightline_${name} PROPERTIES EXPORT_NAME ${name} OUTPUT_NAME ${output} LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/${output}.map)
  target_include_directories(sightline_${name} INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  get_target_property(libraries ${archive} LINK_LIBRARIES)
  target_link_libraries(sightline_${name} PRIVATE ${libraries})
  if(SIGHTLINE_SANITIZE)
    target_link_options(sightline_${name} PUBLIC -fsanitize=${SIGHTLINE_SANITIZE})
  endif()
  if(NOT MSVC)
    target_link_options(sightline_${name} PRIVATE
      -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/${output}.map -Wl,--gc-sections)
  endif()
endfunction()

# Settings that hold for every target: the language, the warnings, and arithmetic that is the same everywhere.
function(sightline_settings target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -ffp-contract=off
    $<$<BOOL:${SIGHTLINE_WERROR}>:-Werror>
    # Collects its garbage later: 0.93 of the time, and a seventh more memory.
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=400000>)
  if(SIGHTLINE_DEBUG_ASSERTS)
    target_compile_definitions(${target} PRIVATE SIGHTLINE_DEBUG_ASSERTS)
  endif()
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)")
    # Processors that have SSSE3 and not SSE4 are older than 2008. Each set costs a fifth of what kernels take to compile.
    if(SIGHTLINE_FEW_TARGETS)
      target_compile_definitions(${target} PRIVATE "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3|HWY_AVX3_DL)")
    else()
      target_compile_definitions(${target} PRIVATE HWY_DISABLED_TARGETS=HWY_SSSE3)
    endif()
  elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)")
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

# A target in which little is hot: -O1 builds it in three quarters of the time.
function(sightline_lukewarm target)
  if(NOT SIGHTLINE_FEW_TARGETS)  # where all is built fast, this is not the exception
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()

# A target in which nothing is hot is optimised little, and so built sooner.
function(sightline_cold target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>)
endfunction()

# Adds the files of the current folder to sightline_TARGET.
function(sightline_sources target)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE files)
  target_sources(sightline_${target} PRIVATE ${files})
endfunction()

# Compiles the files of a target in groups of eight, or of SIZE, of the same folder, which reads the large headers once a group. A file
# with kernels stands alone, because Highway reads it once for every instruction set; so does a file that the build
# makes. Names in anonymous namespaces must differ within a folder.
function(sightline_in_groups target)
  set(size 8 ${ARGN})
  list(GET size -1 size)
  if(SIGHTLINE_GROUPS)
    # The files are known once the whole project has been read.
    cmake_language(EVAL CODE "cmake_language(DEFER DIRECTORY [[${PROJECT_SOURCE_DIR}]] CALL sightline_group ${target} ${size})")
  endif()
endfunction()

function(sightline_group target size)
  get_target_property(files ${target} SOURCES)
  get_target_property(home ${target} SOURCE_DIR)
  foreach(file ${files})
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${home} NORMALIZE)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${file} made)
    if(made)
      continue()  # the build makes it
    endif()
    file(STRINGS ${file} kernels REGEX "hwy/foreach_target" LIMIT_COUNT 1)
    if(kernels)
      continue()
    endif()
    cmake_path(GET file PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER ${folder} key)
    if(NOT DEFINED ${key})
      set(${key} 0)
    endif()
    math(EXPR group "${${key}} / ${size}")
    math(EXPR ${key} "${${key}} + 1")
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE name)
    string(MAKE_C_IDENTIFIER ${name} name)
    set_source_files_properties(${file} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${name}_${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # In a group GCC takes a source for a header, whose anonymous namespaces it warns of.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# Without this option ccache does not keep what is compiled with precompiled headers.
function(sightline_keep_precompiled target)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()

# The headers that nearly every file reads, precompiled.
function(sightline_precompile target)
  target_precompile_headers(${target} PRIVATE
    <algorithm> <array> <bit> <cmath> <cstdint> <cstring> <limits> <memory> <numeric> <optional> <span> <string> <tuple>
    <utility> <vector> <glm/glm.hpp> ${ARGN})
  sightline_keep_precompiled(${target})
endfunction()

# The same for a library of the tools, which share one: sightline_tool_headers. Where no tools are built, its own.
function(sightline_share_precompiled target)
  if(NOT SIGHTLINE_TOOLS)
    sightline_precompile(${target})
    return()
  endif()
  if(NOT TARGET sightline_tool_headers)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/tool_headers.cpp CONTENT "")
    add_library(sightline_tool_headers OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/tool_headers.cpp)
    set_target_properties(sightline_tool_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
    sightline_settings(sightline_tool_headers)
    target_link_libraries(sightline_tool_headers PRIVATE glm::glm fmt::fmt nlohmann_json::nlohmann_json)
    sightline_precompile(sightline_tool_headers <chrono> <filesystem> <fstream> <functional> <mutex> <sstream> <variant>
      <fmt/core.h> <nlohmann/json.hpp>)
  endif()
  target_precompile_headers(${target} REUSE_FROM sightline_tool_headers)
  # GCC takes precompiled headers only with the definitions that they were made with.
  target_compile_definitions(${target} PRIVATE $<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>)
  sightline_keep_precompiled(${target})
endfunction()

# Lets the installation of a component begin with a build of what it holds, if some of that is not there: ./run.sh builds
# the tool alone. What is there is not built anew.
#   TARGETS  that are built together
#   FILES    that are looked for; default: those of the targets
function(sightline_builds_first component)
  cmake_parse_arguments(arg "" "" "TARGETS;FILES" ${ARGN})
  if(NOT arg_FILES)
    list(TRANSFORM arg_TARGETS REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE arg_FILES)
  endif()
  install(CODE "
    set(files \"${arg_FILES}\")
    foreach(file IN LISTS files)
      if(NOT EXISTS \"\${file}\")
        message(STATUS \"Sightline: ${component} is not built yet: building ${arg_TARGETS}\")
        execute_process(COMMAND \"${CMAKE_COMMAND}\" --build \"${CMAKE_BINARY_DIR}\" --config \"\${CMAKE_INSTALL_CONFIG_NAME}\"
          --target ${arg_TARGETS} RESULT_VARIABLE result)
        if(NOT result EQUAL 0)
          message(FATAL_ERROR \"Sightline: ${component} could not be built\")
        endif()
        break()
      endif()
    endforeach()" COMPONENT ${component})
endfunction()
