#pragma once
// The one symbol a program library exports, checked by the loader before anything else of it is touched.

#include <cstdint>

#include "programs/api/abi.hpp"
#include "programs/api/program.hpp"

namespace taktwerk {

/// Layout fixed for ever: a foreign or old library must be recognisable.
struct ProgramEntry {
    std::uint32_t magic;       ///< program_magic
    std::uint32_t entry_size;  ///< sizeof(ProgramEntry)
    std::uint64_t abi_hash;    ///< taktwerk::abi_hash() of the SDK it was built with
    const char* sdk_version;
    const char* name;  ///< class name
    Program* (*create)();
    void (*destroy)(Program*);
};

inline constexpr std::uint32_t program_magic = 0x54574B31;  // "TWK1"
inline constexpr const char* program_entry_symbol = "taktwerk_program_entry";

}  // namespace taktwerk

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
