# What an installation holds: libraries, headers under <sightline/...>, the tool, and how to find them. Its components:
#   runtime      libsightline, which programs that link it need to run, and the licence
#   development  sightline::run, ::c, ::bsp and ::studies with their headers, and the files that find them
#   tools        the programs with their completions
#   tools-development  the libraries that these are made of
#   python       the Python package
#   documentation  the manual
include(CMakePackageConfigHelpers)

# Installs libraries with the headers of their users and exports them as sightline::NAME.
#   COMPONENT  that they belong to; shared libraries to runtime
#   EXPORT     the export set; sightline-config.cmake includes one file for each
#   LIBRARIES  names as given to sightline_library
#   HEADERS    of sightline/, that users include; what these include is installed, too, and no other header
#   BUT        these and what they include, which belong to another component
function(sightline_install)
  cmake_parse_arguments(arg "" "EXPORT;COMPONENT" "LIBRARIES;HEADERS;BUT" ${ARGN})
  list(TRANSFORM arg_LIBRARIES PREPEND sightline_ OUTPUT_VARIABLE targets)
  set(shared ${targets})
  list(FILTER shared INCLUDE REGEX "shared$")
  sightline_builds_first(${arg_COMPONENT} TARGETS ${targets})
  if(shared)
    sightline_builds_first(runtime TARGETS ${shared})
  endif()
  install(TARGETS ${targets} EXPORT ${arg_EXPORT}
    ARCHIVE COMPONENT ${arg_COMPONENT} LIBRARY COMPONENT runtime NAMELINK_COMPONENT ${arg_COMPONENT}
    RUNTIME COMPONENT runtime)
  install(CODE "
    include(${PROJECT_SOURCE_DIR}/cmake/SightlineInstallHeaders.cmake)
    sightline_install_headers(${PROJECT_SOURCE_DIR} \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}
      HEADERS ${arg_HEADERS} BUT ${arg_BUT})"
    COMPONENT ${arg_COMPONENT})
  install(EXPORT ${arg_EXPORT} NAMESPACE sightline:: DESTINATION ${SIGHTLINE_CMAKE_DIR}
    COMPONENT ${arg_COMPONENT})
endfunction()

set(SIGHTLINE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/sightline)

sightline_install(EXPORT sightline-runtime COMPONENT development LIBRARIES run HEADERS sightline.h geom/setting_rows.h)
sightline_install(EXPORT sightline-c COMPONENT development LIBRARIES c shared HEADERS c/sightline.h)
sightline_install(EXPORT sightline-studies COMPONENT development LIBRARIES bsp reference hidden studies
  HEADERS studies/hidden/render.h studies/hidden/zbuffer/zbuffer.h)
if(SIGHTLINE_TOOLS)
  sightline_install(EXPORT sightline-bake COMPONENT development LIBRARIES bake_shared HEADERS c/bake/bake.h)
  sightline_install(EXPORT sightline-tools COMPONENT tools-development LIBRARIES lods scene import bake truth pictures report lab_report
    HEADERS bake/bake.h prepare/lod/lod_chain.h tools/scene/procedural.h tools/import/scene_file.h
            tools/load/load_world.h tools/truth/verify.h tools/report/page/page.h
    BUT sightline.h c/sightline.h studies/hidden/render.h studies/hidden/zbuffer/zbuffer.h)
  # ./run.sh builds the tool alone. Of the other programs, those that were not built are left out.
  sightline_builds_first(tools TARGETS sightline)
  install(TARGETS sightline COMPONENT tools)
  install(TARGETS sightline-lab COMPONENT tools OPTIONAL)
  install(TARGETS sightline-bench COMPONENT tools OPTIONAL)
  if(TARGET sightline-view)
    install(TARGETS sightline-view COMPONENT tools OPTIONAL)
  endif()
  if(TARGET sightline_completions)
    set(pages ${PROJECT_BINARY_DIR}/apps/cli/completions)
    install(FILES ${pages}/sightline DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
      COMPONENT tools OPTIONAL)
    install(FILES ${pages}/_sightline DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions
      COMPONENT tools OPTIONAL)
    install(FILES ${pages}/sightline.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
      COMPONENT tools OPTIONAL)
  endif()
  if(SIGHTLINE_HAS_ASSIMP)
    install(TARGETS sightline-import DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/sightline COMPONENT tools OPTIONAL)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/bin/ifc DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/sightline COMPONENT tools OPTIONAL)
  endif()
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sightline-config.cmake.in
  ${PROJECT_BINARY_DIR}/sightline-config.cmake INSTALL_DESTINATION ${SIGHTLINE_CMAKE_DIR}
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sightline-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sightline-config.cmake ${PROJECT_BINARY_DIR}/sightline-config-version.cmake
  DESTINATION ${SIGHTLINE_CMAKE_DIR} COMPONENT development)

# Written while installing, so that it names the prefix that --prefix chose.
install(CODE "
  set(PROJECT_VERSION ${PROJECT_VERSION})
  set(SIGHTLINE_EMBREE_FLAG $<$<BOOL:${SIGHTLINE_TOOLS}>:-lembree3>)
  set(CMAKE_INSTALL_FULL_LIBDIR \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR})
  set(CMAKE_INSTALL_FULL_INCLUDEDIR \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR})
  foreach(name sightline sightline-c sightline-studies)
    configure_file(${PROJECT_SOURCE_DIR}/cmake/\${name}.pc.in
      \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/pkgconfig/\${name}.pc @ONLY)
  endforeach()" COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}
  COMPONENT runtime)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/manual COMPONENT documentation)
install(FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT documentation
  PATTERN CMakeLists.txt EXCLUDE)
