# One CMake target per folder, named after its path; a folder links only its own floor or lower ones
# (tests/architecture reads the include lines and these lists).
#
#   taktwerk_library(ecat/wire  DEPENDS core)          -> target taktwerk_ecat_wire from ecat/wire/*.cpp
#   taktwerk_tests(ecat/wire    DEPENDS ecat/wire)     -> one binary per kind: ecat_wire_unit, ecat_wire_property, ...
#
# SINGLE, before DEPENDS: the library's files compile each alone, whatever TAKTWERK_UNITY_LIBRARIES says.
#
# Sources are globbed (CONFIGURE_DEPENDS): adding a file needs no edit here.
# A dependency is a folder ("ecat/wire") or a target ("fmt::fmt", yaml-cpp); a folder may be listed before its target exists.

set(TAKTWERK_FLOORS core ecat modbus axes fb_library programs runtime hmi_bridge config apps)
set(TAKTWERK_TEST_KINDS unit property machine conformance)

function(taktwerk_target_name folder out)
  string(REPLACE "/" "_" name "${folder}")
  set(${out} "taktwerk_${name}" PARENT_SCOPE)
endfunction()

function(taktwerk_link target visibility)
  foreach(dependency IN LISTS ARGN)
    string(REGEX REPLACE "/.*" "" floor "${dependency}")
    if(floor IN_LIST TAKTWERK_FLOORS)
      taktwerk_target_name(${dependency} name)
      target_link_libraries(${target} ${visibility} $<TARGET_NAME_IF_EXISTS:${name}>)
    else()
      target_link_libraries(${target} ${visibility} ${dependency})
    endif()
  endforeach()
endfunction()

# Eight files compile in the time of three: most of it goes into headers. What files call their own in unnamed namespaces has to differ
# within a library or a test's binary therefore.
set(TAKTWERK_UNITY 8 CACHE STRING "tests compiled together; 0: each alone")
set(TAKTWERK_UNITY_LIBRARIES 8 CACHE STRING "a library's files compiled together; 0: each alone, as in the clang preset")

function(taktwerk_compile_together target files)
  if(files)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
  endif()
endfunction()

# Where only some libraries are to be sanitized, the others come ready from a build without (`./dev ci`; presets ci_asan and ci_tsan).
set(TAKTWERK_BORROW_FROM "" CACHE PATH "build, made before, whose libraries are taken for TAKTWERK_BORROW")
set(TAKTWERK_BORROW "" CACHE STRING "folders whose libraries are taken from there, e.g. axes/path;fb_library/iec")

function(taktwerk_library folder)
  cmake_parse_arguments(ARG "SINGLE" "" "DEPENDS" ${ARGN})
  taktwerk_target_name(${folder} target)
  string(REPLACE ";" " " line "${folder};${ARG_DEPENDS}")
  set_property(GLOBAL APPEND PROPERTY TAKTWERK_FOLDERS "${line}")
  if(TAKTWERK_BORROW_FROM AND folder IN_LIST TAKTWERK_BORROW)
    string(REGEX REPLACE "/.*" "" floor "${folder}")
    add_library(${target} STATIC IMPORTED GLOBAL)
    set_target_properties(${target} PROPERTIES IMPORTED_LOCATION "${TAKTWERK_BORROW_FROM}/${floor}/lib${target}.a" SYSTEM OFF)
    target_include_directories(${target} INTERFACE "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${target} INTERFACE taktwerk_build_options)
    taktwerk_link(${target} INTERFACE ${ARG_DEPENDS})
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*.cpp")
  if(sources)
    set(visibility PUBLIC)
    add_library(${target} STATIC ${sources})
    if(NOT ARG_SINGLE)
      taktwerk_compile_together(${target} ${TAKTWERK_UNITY_LIBRARIES})
    endif()
  else()
    set(visibility INTERFACE)  # headers only, so far
    add_library(${target} INTERFACE)
  endif()
  target_include_directories(${target} ${visibility} "${PROJECT_SOURCE_DIR}")
  target_link_libraries(${target} ${visibility} taktwerk_build_options)
  taktwerk_link(${target} ${visibility} ${ARG_DEPENDS})
endfunction()

# For a folder that reads and writes text and computes little: with sanitizers the optimiser takes half as long again as the rest of the
# compiler, and what it saves when the tests run is less.
function(taktwerk_unoptimised_when_sanitized folder)
  if(TAKTWERK_SANITIZE AND NOT TAKTWERK_FUZZ AND NOT folder IN_LIST TAKTWERK_BORROW)  # fuzz targets run for hours
    taktwerk_target_name(${folder} target)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Debug>:-O0>)
  endif()
endfunction()

# For a folder that computes much in each cycle.
function(taktwerk_optimised_for_release folder)
  if(NOT folder IN_LIST TAKTWERK_BORROW)  # a borrowed library is compiled already
    taktwerk_target_name(${folder} target)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O3>)
  endif()
endfunction()

# Every folder target so far, for whoever wants them all (benchmarks, header check).
function(taktwerk_all_targets out)
  get_property(lines GLOBAL PROPERTY TAKTWERK_FOLDERS)
  set(targets "")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE " .*" "" folder "${line}")
    taktwerk_target_name(${folder} target)
    list(APPEND targets ${target})
  endforeach()
  set(${out} "${targets}" PARENT_SCOPE)
endfunction()

# Headers that nearly every file of a kind parses are parsed once. Not in the clang preset, which shows that each file includes what it
# uses. GoogleMock is a third of a test's compile time; CLI11 and JSON were half of a command's.
function(taktwerk_parse_once target)
  target_precompile_headers(${target} PRIVATE ${ARGN})
endfunction()

# The library of a folder shares what another target has parsed.
function(taktwerk_parsed_with folder owner)
  if(NOT folder IN_LIST TAKTWERK_BORROW)
    taktwerk_target_name(${folder} target)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

# What tests of a part of the tree have in common beside GoogleMock: half of the compile time of those above the axes.
set(TAKTWERK_TEST_HEADERS_plain)
set(TAKTWERK_TEST_HEADERS_axes axes/axis/axis.hpp)
set(TAKTWERK_TEST_HEADERS_groups axes/axis/axis.hpp axes/group/axis_groups.hpp axes/kinematics/kinematics.hpp)
set(TAKTWERK_TEST_HEADERS_blocks ${TAKTWERK_TEST_HEADERS_groups} fb_library/all_blocks.hpp)
set(TAKTWERK_TEST_HEADERS_machine <nlohmann/json.hpp> fb_library/all_blocks.hpp programs/api/entry.hpp runtime/machine/machine.hpp
  runtime/replay/replay.hpp runtime/run/virtual_runner.hpp runtime/tasks/program_library.hpp runtime/world/world.hpp)

function(taktwerk_test_headers target folder)
  if(folder MATCHES "^axes/group$")
    set(part groups)
  elseif(folder MATCHES "^axes/(axis|drives/analog|drives/gantry|drives/xp200)$")
    set(part axes)
  elseif(folder MATCHES "^(fb_library(/motion|/groups|/gcode_path|)|programs/api|motion_figures)$")
    set(part blocks)
  elseif(folder MATCHES "^(runtime|hmi_bridge|programs|apps|drives|whole_machine|group_hand|machine_walk|campaign)(/|$)")
    set(part machine)
  else()
    set(part plain)
  endif()
  set(owner taktwerk_test_headers_${part})
  if(NOT TARGET ${owner})
    file(WRITE "${PROJECT_BINARY_DIR}/test_headers/none.cpp" "")
    add_executable(${owner} "${PROJECT_BINARY_DIR}/test_headers/none.cpp")  # as the tests are: position-independent alike
    target_link_libraries(${owner} PRIVATE taktwerk_build_options GTest::gmock_main)
    if(NOT part STREQUAL plain)  # whose tests link no more than that, some of them: what these define would differ
      target_link_libraries(${owner} PRIVATE Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json)
    endif()
    target_include_directories(${owner} PRIVATE "${PROJECT_SOURCE_DIR}")
    target_compile_options(${owner} PRIVATE $<$<CONFIG:Debug>:-O0>)
    set(headers ${TAKTWERK_TEST_HEADERS_${part}})
    list(TRANSFORM headers PREPEND "${PROJECT_SOURCE_DIR}/" REGEX "^[^<]")
    taktwerk_parse_once(${owner} <gmock/gmock.h> <gtest/gtest.h> <algorithm> <chrono> <functional> <vector> ${headers})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()

# Seconds of those that take long, so that a clone that has never run them begins with them, and above all with the one that runs alone: it would wait for
# the last of the others otherwise, and they for it. Where they have run, CTest knows by itself.
set(TAKTWERK_LONG_TESTS apps_alone_machine 1000 apps_machine 150 axes_group_property 90 programs_examples_machine 80 whole_machine_property 60 apps_unit 55
  axes_axis_property 45 architecture_unit 38 runtime_machine 31 programs_machine 31 axes_axis_unit 29 ecat_machine 27 apps_lcm_machine 25 hmi_bridge_web_unit 25)

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
      # Tests are compiled once and run once: the compiler's time counts more than theirs.
      target_compile_options(${binary} PRIVATE $<$<CONFIG:Debug>:-O0>)
      target_compile_definitions(${binary} PRIVATE
        TAKTWERK_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TAKTWERK_BINARY_DIR="${PROJECT_BINARY_DIR}")
      taktwerk_link(${binary} PRIVATE ${ARG_DEPENDS} GTest::gmock_main)
      taktwerk_test_headers(${binary} ${folder})
      taktwerk_compile_together(${binary} ${TAKTWERK_UNITY})
      add_test(NAME ${binary} COMMAND ${binary} WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
      set(patience 600)
      if(TAKTWERK_SANITIZE)
        set(patience 1500)  # a sanitized machine takes several times as long
      endif()
      set_tests_properties(${binary} PROPERTIES LABELS ${kind} TIMEOUT ${patience})
      list(FIND TAKTWERK_LONG_TESTS ${binary} place)
      if(place GREATER_EQUAL 0)
        math(EXPR place "${place} + 1")
        list(GET TAKTWERK_LONG_TESTS ${place} seconds)
        set_tests_properties(${binary} PROPERTIES COST ${seconds})
      endif()
    endif()
  endforeach()
endfunction()
