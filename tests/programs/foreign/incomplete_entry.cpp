// Magic and ABI are right, but nothing can be created.
#include "programs/api/entry.hpp"

extern "C" __attribute__((visibility("default"))) const taktwerk::ProgramEntry* taktwerk_program_entry() {
    static const taktwerk::ProgramEntry entry{
        taktwerk::program_magic, sizeof(taktwerk::ProgramEntry), taktwerk::abi_hash(), nullptr, nullptr, nullptr, nullptr};
    return &entry;
}
