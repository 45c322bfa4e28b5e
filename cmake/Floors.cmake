# One CMake target per folder, named after its path; a floor links only lower ones (checked by tests/floors_unit).
#
#   taktwerk_library(ecat/wire  DEPENDS core)          -> target taktwerk_ecat_wire from ecat/wire/*.cpp
#   taktwerk_tests(ecat/wire    DEPENDS ecat/wire)     -> one binary per kind: ecat_wire_unit, ecat_wire_property, ...
#
# Sources are globbed (CONFIGURE_DEPENDS): adding a file needs no edit here.

set(TAKTWERK_TEST_KINDS unit property machine conformance)

function(taktwerk_target_name folder out)
  string(REPLACE "/" "_" name "${folder}")
  set(${out} "taktwerk_${name}" PARENT_SCOPE)
endfunction()

function(taktwerk_link target visibility)
  foreach(dependency IN LISTS ARGN)
    if(TARGET ${dependency} OR dependency MATCHES "::")
      target_link_libraries(${target} ${visibility} ${dependency})
    elseif(EXISTS "${PROJECT_SOURCE_DIR}/${dependency}" AND IS_DIRECTORY "${PROJECT_SOURCE_DIR}/${dependency}")
      taktwerk_target_name(${dependency} name)
      target_link_libraries(${target} ${visibility} ${name})
    else()
      target_link_libraries(${target} ${visibility} ${dependency})
    endif()
  endforeach()
endfunction()

function(taktwerk_library folder)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  taktwerk_target_name(${folder} target)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*.cpp")
  if(sources)
    add_library(${target} STATIC ${sources})
    target_include_directories(${target} PUBLIC "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${target} PUBLIC taktwerk_build_options)
    taktwerk_link(${target} PUBLIC ${ARG_DEPENDS})
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${target} INTERFACE taktwerk_build_options)
    taktwerk_link(${target} INTERFACE ${ARG_DEPENDS})
  endif()
endfunction()

# tests/<folder>/*_<kind>.cpp -> binary <folder>_<kind> with CTest label <kind>.
function(taktwerk_tests folder)
  if(NOT TAKTWERK_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  string(REPLACE "/" "_" base "${folder}")
  foreach(kind IN LISTS TAKTWERK_TEST_KINDS)
    file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tests/${folder}/*_${kind}.cpp")
    if(sources)
      set(binary "${base}_${kind}")
      add_executable(${binary} ${sources})
      target_compile_definitions(${binary} PRIVATE
        TAKTWERK_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TAKTWERK_BINARY_DIR="${PROJECT_BINARY_DIR}")
      taktwerk_link(${binary} PRIVATE ${ARG_DEPENDS} GTest::gmock_main)
      add_test(NAME ${binary} COMMAND ${binary} WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
      set_tests_properties(${binary} PROPERTIES LABELS ${kind} TIMEOUT 300)
    endif()
  endforeach()
endfunction()
