# Every library Taktwerk uses is a Debian package; packaging/apt-packages.txt is the one list of them.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(yaml-cpp REQUIRED)       # 0.7: the target is `yaml-cpp`, without a namespace
find_package(pugixml REQUIRED)        # vendors' ESI files, in ecat/esi
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
if(TAKTWERK_TESTS OR TAKTWERK_BENCH)  # a rig of the tests is what a bench measures
  find_package(GTest REQUIRED)
endif()
if(TAKTWERK_BENCH)
  find_package(benchmark REQUIRED)
endif()

# LCM: Debian's 1.3.1 brings no CMake package and its pkg-config file misses a dependency, so it is found by hand.
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)
add_library(lcm_imported INTERFACE)
target_include_directories(lcm_imported SYSTEM INTERFACE "${LCM_INCLUDE_DIR}")
target_link_libraries(lcm_imported INTERFACE "${LCM_LIBRARY}")

# libmodbus: a pkg-config file only, as LCM.
find_path(LIBMODBUS_INCLUDE_DIR modbus/modbus.h REQUIRED)  # libmodbus-dev
find_library(LIBMODBUS_LIBRARY modbus REQUIRED)
add_library(libmodbus_imported INTERFACE)
target_include_directories(libmodbus_imported SYSTEM INTERFACE "${LIBMODBUS_INCLUDE_DIR}")
target_link_libraries(libmodbus_imported INTERFACE "${LIBMODBUS_LIBRARY}")

# zstd: Debian's package has a pkg-config file only.
find_path(ZSTD_INCLUDE_DIR zstd.h REQUIRED)  # libzstd-dev
find_library(ZSTD_LIBRARY zstd REQUIRED)
add_library(zstd_imported INTERFACE)
target_include_directories(zstd_imported SYSTEM INTERFACE "${ZSTD_INCLUDE_DIR}")
target_link_libraries(zstd_imported INTERFACE "${ZSTD_LIBRARY}")
# SQLite: CMake has a module of its own for it.
find_package(SQLite3 REQUIRED)  # libsqlite3-dev

# Boost: headers of Asio and Beast for the page's server; nothing to link.
find_path(BOOST_BEAST_INCLUDE_DIR boost/beast.hpp REQUIRED)  # libboost-dev
add_library(boost_imported INTERFACE)
target_include_directories(boost_imported SYSTEM INTERFACE "${BOOST_BEAST_INCLUDE_DIR}")
target_link_libraries(boost_imported INTERFACE Threads::Threads)

# libsodium: a pkg-config file only. Argon2id and random tokens for the page's users; SHA-256 and Ed25519 for bundles.
find_path(SODIUM_INCLUDE_DIR sodium.h REQUIRED)  # libsodium-dev
find_library(SODIUM_LIBRARY sodium REQUIRED)
add_library(sodium_imported INTERFACE)
target_include_directories(sodium_imported SYSTEM INTERFACE "${SODIUM_INCLUDE_DIR}")
target_link_libraries(sodium_imported INTERFACE "${SODIUM_LIBRARY}")
