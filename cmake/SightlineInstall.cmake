# What an installation holds: libraries, headers under <sightline/...>, the tool, and how to find them.
include(CMakePackageConfigHelpers)

# Installs libraries with the headers of their folders and exports them as sightline::NAME.
#   EXPORT     the export set; sightline-config.cmake includes one file for each
#   LIBRARIES  names as given to sightline_library
#   FOLDERS    folders of sightline/ whose headers belong to them
function(sightline_install)
  cmake_parse_arguments(arg "" "EXPORT" "LIBRARIES;FOLDERS" ${ARGN})
  list(TRANSFORM arg_LIBRARIES PREPEND sightline_ OUTPUT_VARIABLE targets)
  install(TARGETS ${targets} EXPORT ${arg_EXPORT})
  foreach(folder ${arg_FOLDERS})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/sightline/${folder}
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sightline FILES_MATCHING PATTERN "*.h")
  endforeach()
  install(EXPORT ${arg_EXPORT} NAMESPACE sightline:: DESTINATION ${SIGHTLINE_CMAKE_DIR})
endfunction()

set(SIGHTLINE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/sightline)

sightline_install(EXPORT sightline-runtime LIBRARIES run
  FOLDERS base math geom space raster cull prepare visfile run)
sightline_install(EXPORT sightline-hidden LIBRARIES hidden FOLDERS hidden)
if(SIGHTLINE_TOOLS)
  sightline_install(EXPORT sightline-tools LIBRARIES scene import bake truth report
    FOLDERS scene load import bake truth report)
  install(TARGETS sightline)
  if(TARGET sightline_pages)
    set(pages ${PROJECT_BINARY_DIR}/apps/cli/pages)
    install(FILES ${pages}/sightline.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    install(FILES ${pages}/sightline DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
    install(FILES ${pages}/_sightline DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
    install(FILES ${pages}/sightline.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
  endif()
  if(SIGHTLINE_HAS_ASSIMP)
    install(TARGETS sightline-import DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/sightline)
  endif()
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sightline-config.cmake.in
  ${PROJECT_BINARY_DIR}/sightline-config.cmake INSTALL_DESTINATION ${SIGHTLINE_CMAKE_DIR}
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sightline-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sightline-config.cmake ${PROJECT_BINARY_DIR}/sightline-config-version.cmake
  DESTINATION ${SIGHTLINE_CMAKE_DIR})

# Written while installing, so that it names the prefix that --prefix chose.
install(CODE "
  set(PROJECT_VERSION ${PROJECT_VERSION})
  set(SIGHTLINE_EMBREE_FLAG $<$<BOOL:${SIGHTLINE_TOOLS}>:-lembree3>)
  set(CMAKE_INSTALL_FULL_LIBDIR \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR})
  set(CMAKE_INSTALL_FULL_INCLUDEDIR \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR})
  foreach(name sightline sightline-hidden)
    configure_file(${PROJECT_SOURCE_DIR}/cmake/\${name}.pc.in
      \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/pkgconfig/\${name}.pc @ONLY)
  endforeach()")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
