#pragma once
// The one symbol a program library exports, checked by the loader before anything else of it is touched.

#include "programs/api/abi.hpp"
#include "programs/api/program.hpp"
#include "programs/api/program_entry.hpp"

/// Once per shared object, outside any namespace.
#define TAKTWERK_PROGRAM(Type)                                                                                   \
    extern "C" __attribute__((visibility("default"))) const ::taktwerk::ProgramEntry* taktwerk_program_entry() { \
        static const ::taktwerk::ProgramEntry entry{::taktwerk::program_magic,                                   \
                                                    sizeof(::taktwerk::ProgramEntry),                            \
                                                    ::taktwerk::abi_hash(),                                      \
                                                    ::taktwerk::sdk_version,                                     \
                                                    #Type,                                                       \
                                                    []() -> ::taktwerk::Program* { return new Type; },           \
                                                    [](::taktwerk::Program* program) { delete program; }};       \
        return &entry;                                                                                           \
    }
