#pragma once
// Slaves for the planner's tests.

#include <string>

#include "ecat/layout/slave_mapping.hpp"

namespace taktwerk::ecat::test {

/// SV33-E manual 7.1: 1702h is 19 bytes, 1B02h 25 bytes; entries at odd offsets behind 8-bit objects.
inline PlanSlave servo(const std::string& name) {
    PlanSlave slave;
    slave.subject = name;
    slave.sync_managers = {{SmUse::mailbox_out, 0x1000, 0x80, 0x26},
                           {SmUse::mailbox_in, 0x1400, 0x80, 0x22},
                           {SmUse::outputs, 0x1800, 0, 0x64},
                           {SmUse::inputs, 0x1C00, 0, 0x20}};
    slave.rx = {{0x1702,
                 true,
                 {{0x6040, 0, 16}, {0x607A, 0, 32}, {0x60FF, 0, 32}, {0x6071, 0, 16}, {0x6060, 0, 8}, {0x60B8, 0, 16}, {0x607F, 0, 32}}}};
    slave.tx = {{0x1B02,
                 true,
                 {{0x603F, 0, 16},
                  {0x6041, 0, 16},
                  {0x6064, 0, 32},
                  {0x6077, 0, 16},
                  {0x6061, 0, 8},
                  {0x60B9, 0, 16},
                  {0x60BA, 0, 32},
                  {0x60BC, 0, 32},
                  {0x60FD, 0, 32}}}};
    return slave;
}

/// 12 digital inputs in a 2-byte input manager, 4 outputs in a 1-byte output manager, no mailbox.
inline PlanSlave terminal() {
    PlanSlave slave;
    slave.subject = "io";
    slave.coe = false;
    slave.sync_managers = {{SmUse::outputs, 0x0F00, 1, 0x44}, {SmUse::inputs, 0x1000, 2, 0x00}};
    PdoDescription in{0x1A00, true, {}}, out{0x1600, true, {}};
    for (std::uint8_t i = 1; i <= 12; ++i) in.entries.push_back({0x6000, i, 1});
    for (std::uint8_t i = 1; i <= 4; ++i) out.entries.push_back({0x7000, i, 1});
    slave.tx = {in};
    slave.rx = {out};
    return slave;
}

}  // namespace taktwerk::ecat::test
