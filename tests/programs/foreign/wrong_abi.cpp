// As if built against an SDK whose layouts differ. Its functions must not be called: they do not exist.
#include "programs/api/entry.hpp"

extern "C" __attribute__((visibility("default"))) const taktwerk::ProgramEntry* taktwerk_program_entry() {
    static const taktwerk::ProgramEntry entry{
        taktwerk::program_magic, sizeof(taktwerk::ProgramEntry), ~taktwerk::abi_hash(), "0.0.7", "Old", nullptr, nullptr};
    return &entry;
}
