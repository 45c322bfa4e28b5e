# How a machine program is built. The tree builds its examples with it and the installed SDK brings it along, so both agree.
#
#   taktwerk_add_program(cell cell.cpp recipe.cpp)     -> cell.so, to be named by `library:` in the machine file
#
# The target is an ordinary CMake target: add include directories, options or static libraries to it as usual.
function(taktwerk_add_program name)
  if(NOT ARGN)
    message(FATAL_ERROR "taktwerk_add_program(${name} ...): no source files")
  endif()
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE Taktwerk::sdk)
  # C++20 exactly: the language version is part of the ABI hash.
  set_target_properties(${name} PROPERTIES PREFIX "" SUFFIX ".so" CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  # The same machine gives the same set-points to the last bit on every PC: no fused multiply-add, no relaxed arithmetic.
  target_compile_options(${name} PRIVATE -fno-fast-math -ffp-contract=off -fno-math-errno)
  # A function that is declared but nowhere defined is an error here, not when the machine starts. (A sanitizer's run-time
  # library is in the executable; then this cannot be checked.)
  if(NOT TAKTWERK_SANITIZE)
    target_link_options(${name} PRIVATE -Wl,-z,defs)
  endif()
endfunction()
