# What every Taktwerk target is compiled with.
# -ffp-contract=off: the same machine must give the same set-points to the last bit on every x86-64 (recordings replay).
add_library(taktwerk_build_options INTERFACE)
target_compile_features(taktwerk_build_options INTERFACE cxx_std_20)
# Two warnings are of no use for files that are compiled together: a local name hides what another file calls its own, and every file of the
# group counts as a header, whose types must not have members from an unnamed namespace (libraries have such types, tests do not).
set(single $<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>)
set(library $<STREQUAL:$<TARGET_PROPERTY:TYPE>,STATIC_LIBRARY>)
target_compile_options(taktwerk_build_options INTERFACE
  -ffp-contract=off -fno-math-errno -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  $<${single}:-Wshadow> $<$<AND:$<NOT:${single}>,${library},$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>)
# Nobody replaces a function of ours from outside (programs get what they are handed): calls may be inlined although the code is
# position independent. What ships only: a test's binary is linked more often than it is run.
target_compile_options(taktwerk_build_options INTERFACE $<$<CONFIG:Release>:-fno-semantic-interposition>)
# g++ collects its garbage from 10 % of the computer's memory on, over and over: a tenth of the time that this tree takes. Here not before half a GB.
target_compile_options(taktwerk_build_options INTERFACE "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param=ggc-min-heapsize=524288 --param=ggc-min-expand=100>")
if(TAKTWERK_TESTS)
  target_compile_options(taktwerk_build_options INTERFACE -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # The 531 pins of Part 1 are one array, which Clang's limit of 256 nested expressions does not hold.
    target_compile_options(taktwerk_build_options INTERFACE -fbracket-depth=1024)
  endif()
  # A span or array read out of bounds ends the test at once, in every preset that builds tests.
  target_compile_definitions(taktwerk_build_options INTERFACE _GLIBCXX_ASSERTIONS)
endif()
if(TAKTWERK_SANITIZE)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # Clang 14 puts this check's data where a coroutine's parts cannot reach it: "Cannot represent a difference across sections".
    set(TAKTWERK_SANITIZE_EXCEPT -fno-sanitize=function)
  endif()
  # g++ 12 takes std::regex for uninitialised once sanitizers instrument it.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(taktwerk_build_options INTERFACE -Wno-maybe-uninitialized)
  endif()
  target_compile_options(taktwerk_build_options INTERFACE -fsanitize=${TAKTWERK_SANITIZE} ${TAKTWERK_SANITIZE_EXCEPT} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(taktwerk_build_options INTERFACE -fsanitize=${TAKTWERK_SANITIZE})
endif()

# A fast linker where there is one: some sixty test binaries are linked from the same static libraries.
find_program(MOLD mold)
if(MOLD)
  add_link_options(-fuse-ld=mold)
endif()
