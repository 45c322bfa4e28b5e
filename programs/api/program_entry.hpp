#pragma once
// What a program library exports, as its loader sees it. Apart from entry.hpp, so that whoever only carries an entry about does not
// parse every block for the ABI hash.

#include <cstdint>

namespace taktwerk {

class Program;

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
