# cmake --install BUILD --prefix P [--component runtime|hmi|sdk]
#
#   runtime  bin/taktwerk · share/taktwerk/{drives,machines} · lib/taktwerk/programs (the examples)
#            share/taktwerk/schema (JSON Schema of machine and drive files, for editors)
#            share/doc/taktwerk (README, LICENSE, docs/ and the protocol of the socket, with their links to each other intact)
#   hmi      share/taktwerk/hmi: the page, where it could be built
#   sdk      include/taktwerk/ · lib/cmake/Taktwerk: what find_package(Taktwerk) needs to build programs elsewhere
#            include/taktwerk_lcm/ · share/taktwerk/{lcm,examples/lcm}: what somebody else's HMI needs (Taktwerk::lcm, docs/lcm.md)
#
# The SDK holds no library: blocks are headers, and a program reaches the machine only through what it is handed.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(TAKTWERK_SDK_ROOTS programs/api/entry.hpp fb_library/all_blocks.hpp)
set(TAKTWERK_SDK_INCLUDE "${CMAKE_INSTALL_INCLUDEDIR}/taktwerk")
set(sdk_cmake lib/cmake/Taktwerk)
set(programs_folder lib/taktwerk/programs)  # not LIBDIR: bin/taktwerk finds it as ../lib/taktwerk/programs

# --- runtime ----------------------------------------------------------------------------------------------------------------
if(TARGET taktwerk)
  install(TARGETS taktwerk RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT runtime)
endif()
foreach(folder drives devices machines)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/config/${folder}" DESTINATION "${CMAKE_INSTALL_DATADIR}/taktwerk" COMPONENT runtime
    FILES_MATCHING PATTERN "*.yaml" PATTERN "*.svg")
endforeach()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/config/schema" DESTINATION "${CMAKE_INSTALL_DATADIR}/taktwerk" COMPONENT runtime
  FILES_MATCHING PATTERN "*.json")
set(doc_folder "${CMAKE_INSTALL_DATAROOTDIR}/doc/taktwerk")  # Debian's name for it, not the project's capital
install(FILES "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${doc_folder}" COMPONENT runtime)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${doc_folder}" COMPONENT runtime)
install(FILES "${PROJECT_SOURCE_DIR}/hmi_bridge/README.md" DESTINATION "${doc_folder}/hmi_bridge" COMPONENT runtime)
install(FILES "${PROJECT_SOURCE_DIR}/hmi_bridge/web/README.md" DESTINATION "${doc_folder}/hmi_bridge/web" COMPONENT runtime)
get_property(examples GLOBAL PROPERTY TAKTWERK_EXAMPLE_PROGRAMS)
if(examples)
  install(TARGETS ${examples} LIBRARY DESTINATION "${programs_folder}" COMPONENT runtime)
endif()

# --- sdk --------------------------------------------------------------------------------------------------------------------
# What a program reports as its SDK and what find_package() compares must be the same number.
file(STRINGS "${PROJECT_SOURCE_DIR}/programs/api/abi.hpp" line REGEX "sdk_version = ")
if(NOT line MATCHES "\"${PROJECT_VERSION}\"")
  message(FATAL_ERROR "programs/api/abi.hpp: sdk_version is not the project's version ${PROJECT_VERSION}")
endif()

install(CODE "set(TAKTWERK_SOURCE [[${PROJECT_SOURCE_DIR}]])
set(TAKTWERK_SDK_ROOTS [[${TAKTWERK_SDK_ROOTS}]])
set(TAKTWERK_SDK_INCLUDE [[${TAKTWERK_SDK_INCLUDE}]])" COMPONENT sdk)
install(SCRIPT "${PROJECT_SOURCE_DIR}/cmake/InstallSdkHeaders.cmake" COMPONENT sdk)

configure_package_config_file(cmake/TaktwerkConfig.cmake.in "${PROJECT_BINARY_DIR}/sdk/TaktwerkConfig.cmake"
  INSTALL_DESTINATION "${sdk_cmake}" PATH_VARS TAKTWERK_SDK_INCLUDE CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/sdk/TaktwerkConfigVersion.cmake" VERSION "${PROJECT_VERSION}"
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)  # headers only; whether a program fits a runtime is the ABI hash's business
install(FILES "${PROJECT_BINARY_DIR}/sdk/TaktwerkConfig.cmake" "${PROJECT_BINARY_DIR}/sdk/TaktwerkConfigVersion.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/TaktwerkProgram.cmake" DESTINATION "${sdk_cmake}" COMPONENT sdk)
if(TARGET taktwerk_lcm_types)
  install(DIRECTORY "${PROJECT_BINARY_DIR}/lcm_types/taktwerk_lcm" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT sdk FILES_MATCHING PATTERN "*.hpp")
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/hmi_bridge/lcm/" DESTINATION "${CMAKE_INSTALL_DATADIR}/taktwerk/lcm" COMPONENT sdk
    FILES_MATCHING PATTERN "*.lcm" PATTERN examples EXCLUDE)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/hmi_bridge/lcm/examples/" DESTINATION "${CMAKE_INSTALL_DATADIR}/taktwerk/examples/lcm" COMPONENT sdk)
endif()

include(Package)
