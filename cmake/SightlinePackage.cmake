# Debian packages of the installation: `cpack --config build/release/CPackConfig.cmake` writes them to build/release/packages.
#   libsightline0.1   libsightline, for programs that were linked with it
#   libsightline-dev  headers and libraries to build with
#   libsightline-tools-dev  the libraries that the tool is made of: importers, bakes, witnesses, reports
#   sightline         the command line tool, the benchmarks and the viewer, with their completions
#   python3-sightline the Python package
#   sightline-doc     the manual
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sightline)
set(CPACK_PACKAGE_VENDOR "The Sightline authors")
set(CPACK_PACKAGE_CONTACT "The Sightline authors <sightline@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "What can be seen, from any view of any 3D world")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_SET_DESTDIR ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development tools-development tools python documentation)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})

set(runtime libsightline${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(same "(= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${runtime})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsightline-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${runtime} ${same}, libglm-dev, libhwy-dev")
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME sightline)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS nodejs)  # which reads IFC
set(CPACK_DEBIAN_TOOLS-DEVELOPMENT_PACKAGE_NAME libsightline-tools-dev)
set(CPACK_DEBIAN_TOOLS-DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_TOOLS-DEVELOPMENT_PACKAGE_DEPENDS "libsightline-dev ${same}, libembree-dev, libgmp-dev, libfmt-dev, nlohmann-json3-dev, libmeshoptimizer-dev, libdraco-dev, zlib1g-dev")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-sightline)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${runtime} ${same}, python3-cffi, python3-numpy")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_NAME sightline-doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SHLIBDEPS OFF)
include(CPack)
