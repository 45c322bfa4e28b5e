#pragma once
// Who a slave is: the four numbers of SII words 8..15 and of object 1018h.

#include <cstdint>

namespace taktwerk::ecat {

struct Identity {
    std::uint32_t vendor = 0, product = 0, revision = 0, serial = 0;
    friend bool operator==(const Identity&, const Identity&) = default;
};

}  // namespace taktwerk::ecat
