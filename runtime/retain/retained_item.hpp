#pragma once
// A variable or a whole block of a program that is kept over a time without power (Declaration::retain).

#include <cstddef>
#include <string>

#include "fb_library/block_type.hpp"
#include "programs/api/program.hpp"

namespace taktwerk::runtime {

struct RetainedItem {
    static constexpr std::size_t no_task = static_cast<std::size_t>(-1);

    std::string name;  ///< "program.variable"
    RetainKind kind = RetainKind::retain;
    fb::PinKind type = fb::PinKind::LREAL;  ///< of a variable
    const fb::BlockType* block = nullptr;   ///< of a block
    void* address = nullptr;
    std::size_t size = 0;        ///< bytes
    std::size_t program = 0;     ///< as MachineConfig::programs
    std::size_t task = no_task;  ///< its place among the tasks, where the program has said whose it is
};

}  // namespace taktwerk::runtime
