# Debian packages: `cmake --build BUILD --target package`, or ./dev package. Three of them:
#
#   taktwerk      the command, drives, devices, examples, schemas, documentation, man pages, completion, the unit taktwerk@MACHINE
#   taktwerk-hmi  the page and its unit; needs no node
#   taktwerk-dev  what building programs and other people's HMIs takes
#
# They start nothing, and an upgrade restarts nothing (docs/service.md). Included by Install.cmake at its end.
set(package_files "${PROJECT_SOURCE_DIR}/packaging")

# --- man pages and completion: made of the command's own options --------------------------------------------------------------
if(TARGET taktwerk AND NOT TAKTWERK_SANITIZE)
  set(manual "${PROJECT_BINARY_DIR}/manual")
  add_custom_command(OUTPUT "${manual}/done"
    COMMAND ${CMAKE_COMMAND} -E rm -rf "${manual}"
    COMMAND ${CMAKE_COMMAND} -E make_directory "${manual}/man1"
    COMMAND taktwerk docs man -o "${manual}/man1"
    COMMAND taktwerk docs completion -o "${manual}/taktwerk"
    COMMAND sh -c "gzip -9n '${manual}'/man1/*.1"
    COMMAND ${CMAKE_COMMAND} -E touch "${manual}/done"
    DEPENDS taktwerk COMMENT "Man pages and completion" VERBATIM)
  add_custom_target(taktwerk_manual ALL DEPENDS "${manual}/done")
  install(DIRECTORY "${manual}/man1" DESTINATION "${CMAKE_INSTALL_MANDIR}" COMPONENT runtime OPTIONAL)
  install(FILES "${manual}/taktwerk" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT runtime OPTIONAL)
endif()

# --- units ----------------------------------------------------------------------------------------------------------------------
install(FILES "${package_files}/systemd/taktwerk@.service" DESTINATION lib/systemd/system COMPONENT runtime)
install(FILES "${package_files}/systemd/taktwerk.rules" DESTINATION lib/udev/rules.d RENAME 60-taktwerk.rules COMPONENT runtime)
install(FILES "${package_files}/systemd/bundle.conf" DESTINATION "${CMAKE_INSTALL_DATADIR}/taktwerk/systemd" COMPONENT runtime)
install(FILES "${package_files}/systemd/taktwerk.sysusers" DESTINATION lib/sysusers.d RENAME taktwerk.conf COMPONENT runtime)
install(FILES "${package_files}/systemd/taktwerk-hmi.service" DESTINATION lib/systemd/system COMPONENT hmi)
install(FILES "${package_files}/systemd/taktwerk-hmi.sysusers" DESTINATION lib/sysusers.d RENAME taktwerk-hmi.conf COMPONENT hmi)

# --- what Debian wants of each package --------------------------------------------------------------------------------------------
set(deb "${PROJECT_BINARY_DIR}/deb")
file(MAKE_DIRECTORY "${deb}")
execute_process(COMMAND gzip -9nc "${package_files}/deb/changelog" OUTPUT_FILE "${deb}/changelog.gz" COMMAND_ERROR_IS_FATAL ANY)
set(package_of_runtime taktwerk)
set(package_of_hmi taktwerk-hmi)
set(package_of_sdk taktwerk-dev)
foreach(component runtime hmi sdk)
  set(folder "${CMAKE_INSTALL_DATAROOTDIR}/doc/${package_of_${component}}")
  install(FILES "${package_files}/deb/copyright" "${deb}/changelog.gz" DESTINATION "${folder}" COMPONENT ${component})
endforeach()

install(FILES "${package_files}/deb/lintian-overrides" DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides" RENAME taktwerk COMPONENT runtime)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME taktwerk)
set(CPACK_PACKAGE_VENDOR "Taktwerk")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package's own stands in the first line of its description
set(CPACK_PACKAGE_CONTACT "Taktwerk developers <taktwerk@example.org>")
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime hmi sdk)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION electronics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME taktwerk)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "soft-PLC and motion runtime
Turns a Linux industrial PC into a machine controller: a cyclic runtime with
IEC 61131-3 and PLCopen function blocks, an EtherCAT master, CiA 402 axes.
Machines are described in a YAML file and run as the service taktwerk@NAME.

Not safety-rated.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "adduser")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "taktwerk-hmi, gnuplot-nox, linux-image-rt-amd64")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${package_files}/deb/runtime/postinst;${package_files}/deb/runtime/prerm;${package_files}/deb/runtime/postrm")

set(CPACK_DEBIAN_HMI_PACKAGE_NAME taktwerk-hmi)
set(CPACK_DEBIAN_HMI_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_HMI_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_HMI_DESCRIPTION "page of Taktwerk machines for a browser
Overview, axes, scope, I/O, alarms, bus of the machines of this computer, in
Chinese and English, served on loopback as the service taktwerk-hmi.")
set(CPACK_DEBIAN_HMI_PACKAGE_DEPENDS "taktwerk (= ${PROJECT_VERSION}), adduser")
set(CPACK_DEBIAN_HMI_PACKAGE_CONTROL_EXTRA "${package_files}/deb/hmi/postinst;${package_files}/deb/hmi/prerm;${package_files}/deb/hmi/postrm")

set(CPACK_DEBIAN_SDK_PACKAGE_NAME taktwerk-dev)
set(CPACK_DEBIAN_SDK_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_SDK_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_SDK_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_SDK_DESCRIPTION "headers for programs of Taktwerk machines
What building programs and other people's HMIs takes: function blocks, the
program interface, CMake support, LCM types with generated C++ headers.")
set(CPACK_DEBIAN_SDK_PACKAGE_DEPENDS "g++, cmake")
set(CPACK_DEBIAN_SDK_PACKAGE_SUGGESTS "taktwerk (= ${PROJECT_VERSION}), liblcm-dev")
include(CPack)
