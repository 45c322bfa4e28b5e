// Exports the symbol, but what it returns is something else.
#include "programs/api/entry.hpp"

extern "C" __attribute__((visibility("default"))) const taktwerk::ProgramEntry* taktwerk_program_entry() {
    static const taktwerk::ProgramEntry entry{0x12345678, sizeof(taktwerk::ProgramEntry), taktwerk::abi_hash(), nullptr, nullptr, nullptr,
                                              nullptr};
    return &entry;
}
