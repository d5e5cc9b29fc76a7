# Fetches web-ifc, which reads IFC, by npm: cmake -D FOLDER=... -P FetchWebIfc.cmake
# Where it cannot be had, one line says so and nothing is written: the build goes on, without IFC.
set(version 0.0.78)
# Of the archive that npm fetches, as hexadecimal SHA-512: `npm view web-ifc@VERSION dist.integrity`, in base 64.
set(hash 2c628c358155372cfdbd51113748b3fb3bcf409a93ecc106071b25cdcbae8700c3380d75e8b9892ca920f2c679484bd025273935154c5a0a513640e6ba842826)
set(wanted LICENSE.md package.json web-ifc-api-node.js web-ifc-node.wasm)

function(leave_out reason)
  message("sightline: IFC is left out of this build: ${reason}")
endfunction()

find_program(NPM npm)
if(NOT NPM)
  leave_out("npm, which fetches web-ifc, is not installed (apt install npm)")
  return()
endif()
set(work ${FOLDER}.fetched)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work})
execute_process(COMMAND ${CMAKE_COMMAND} -E env npm_config_fetch_retries=0 npm_config_fetch_timeout=60000
    npm_config_update_notifier=false ${NPM} pack web-ifc@${version} --ignore-scripts --prefer-offline --silent
  WORKING_DIRECTORY ${work} RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET TIMEOUT 180)
set(archive ${work}/web-ifc-${version}.tgz)
if(NOT result EQUAL 0 OR NOT EXISTS ${archive})
  file(REMOVE_RECURSE ${work})
  leave_out("npm could not fetch web-ifc ${version}; build again where it can")
  return()
endif()
file(SHA512 ${archive} found)
if(NOT found STREQUAL hash)
  file(REMOVE_RECURSE ${work})
  message(FATAL_ERROR "web-ifc ${version} is not the package that was tried: its SHA-512 is ${found}")
endif()
list(TRANSFORM wanted PREPEND package/ OUTPUT_VARIABLE patterns)
file(ARCHIVE_EXTRACT INPUT ${archive} DESTINATION ${work} PATTERNS ${patterns})
file(MAKE_DIRECTORY ${FOLDER})
foreach(name ${wanted})
  file(RENAME ${work}/package/${name} ${FOLDER}/${name})
  file(TOUCH ${FOLDER}/${name})  # the archive's own dates are of 1985
endforeach()
file(REMOVE_RECURSE ${work})
