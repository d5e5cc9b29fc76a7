# The steps of the consumer test; see CMakeLists.txt for its arguments.
set(project ${CMAKE_CURRENT_LIST_DIR}/project)
set(prefix ${WORK}/prefix)
file(REMOVE_RECURSE ${prefix} ${WORK}/build)

function(step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${what} failed (${code}):\n${output}")
  endif()
  message(STATUS "${what}: passed")
endfunction()

step("install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --config ${CONFIG})
step("configure" ${CMAKE_COMMAND} -S ${project} -B ${WORK}/build -G Ninja -D CMAKE_PREFIX_PATH=${prefix}
  -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
  -D CMAKE_BUILD_TYPE=${CONFIG} -D CONSUMER_TOOLS=${TOOLS}
  -D CONSUMER_EXAMPLES=${EXAMPLES})
step("build" ${CMAKE_COMMAND} --build ${WORK}/build)
foreach(program consumer first_query portals_and_doors shadow_casters occlusion_buffer hello occluder_buffer hello_static)
  step("run ${program}" ${WORK}/build/${program})
endforeach()
# By components: what a game is built with, and the tool.
set(parts ${WORK}/parts)
file(REMOVE_RECURSE ${parts})
foreach(component runtime development tools)
  step("install ${component}" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${parts}/${component} --config ${CONFIG}
    --component ${component})
endforeach()
function(expect component yes_or_no file)
  file(GLOB found ${parts}/${component}/${file})
  if((found AND NOT yes_or_no) OR (NOT found AND yes_or_no))
    message(FATAL_ERROR "component ${component}: ${file} is there: ${found}")
  endif()
endfunction()
expect(development TRUE include/sightline/sightline.h)
expect(development TRUE ${LIBDIR}/libsightline_run.*)
expect(development TRUE ${LIBDIR}/cmake/sightline/sightline-config.cmake)
expect(development TRUE ${LIBDIR}/pkgconfig/sightline.pc)
expect(development FALSE bin/sightline)
expect(development FALSE include/sightline/tools)
expect(runtime FALSE include)
expect(runtime TRUE ${LIBDIR}/libsightline.so.*)
expect(development TRUE ${LIBDIR}/libsightline.so)
expect(development TRUE include/sightline/c/sightline.h)
expect(development FALSE include/sightline/c/impl)
if(TOOLS)
  expect(tools TRUE bin/sightline)
  expect(tools FALSE include/sightline/sightline.h)
endif()
# Games are compiled without exceptions and without types at run time.
foreach(example first_query portals_and_doors shadow_casters occlusion_buffer)
  step("compile ${example} without exceptions" ${COMPILER} -std=c++20 -fno-exceptions -fno-rtti -fsyntax-only
    -I ${prefix}/include ${EXAMPLES}/${example}.cpp)
endforeach()
# An older language is refused in one line.
execute_process(COMMAND ${COMPILER} -std=c++17 -fsyntax-only -I ${prefix}/include ${EXAMPLES}/first_query.cpp
  RESULT_VARIABLE code ERROR_VARIABLE said)
if(code EQUAL 0 OR NOT said MATCHES "Sightline needs C\\+\\+20")
  message(FATAL_ERROR "C++17 is not refused:\n${said}")
endif()
# As a part of another project: the library alone is configured, by its names.
foreach(way add_subdirectory FetchContent)
  string(COMPARE EQUAL ${way} FetchContent by_fetch)
  step(${way} ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/part -B ${WORK}/${way} -G Ninja
    -D CMAKE_CXX_COMPILER=${COMPILER} -D SIGHTLINE_SOURCE=${EXAMPLES}/.. -D BY_FETCH=${by_fetch})
endforeach()

if(TOOLS)
  step("run tools" ${WORK}/build/consumer_of_tools)
  step("run bake" ${WORK}/build/bake building:1:1 ${WORK}/build/house.vis)
endif()

find_program(pkg_config pkg-config)
if(pkg_config AND NOT SANITIZE)
  set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
  function(by_pkg_config package source)
    execute_process(COMMAND ${pkg_config} --cflags --libs ${package} OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    step("build with ${package}.pc" ${COMPILER} -std=c++20 ${source} ${flags} -o ${WORK}/build/by_pkg_config)
    step("run with ${package}.pc" ${WORK}/build/by_pkg_config)
  endfunction()
  by_pkg_config(sightline ${EXAMPLES}/first_query.cpp)
  by_pkg_config(sightline-studies ${project}/main.cpp)
  # A C compiler alone, as strict as there is.
  set(ENV{LD_LIBRARY_PATH} ${prefix}/${LIBDIR})
  execute_process(COMMAND ${pkg_config} --cflags --libs sightline-c OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  step("build hello.c with sightline-c.pc" ${C_COMPILER} -std=c99 -pedantic -Wall -Werror ${EXAMPLES}/hello.c ${flags}
    -lm -o ${WORK}/build/hello_by_pkg_config)
  step("run hello.c with sightline-c.pc" ${WORK}/build/hello_by_pkg_config)
endif()
