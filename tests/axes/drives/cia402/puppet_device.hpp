#pragma once
// The description of a slave that has the CiA 402 objects a test names, mapped as it says, and nothing else.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ecat/description/device_description.hpp"

namespace taktwerk::axes::cia402::test {

using namespace std::chrono_literals;

using Objects = std::vector<std::pair<std::uint16_t, std::uint8_t>>;

/// CiA 402 objects of one axis; types as in the SV33-E manual 7.3.
inline ecat::ObjectEntry object(std::uint16_t index, std::uint8_t sub = 0) {
    using ecat::DataType;
    static const std::map<std::uint16_t, DataType> types{
        {0x603F, DataType::U16}, {0x6040, DataType::U16}, {0x6041, DataType::U16}, {0x6060, DataType::I8},  {0x6061, DataType::I8},
        {0x6064, DataType::I32}, {0x606C, DataType::I32}, {0x6071, DataType::I16}, {0x6072, DataType::U16}, {0x6077, DataType::I16},
        {0x607A, DataType::I32}, {0x607F, DataType::U32}, {0x6083, DataType::U32}, {0x60B1, DataType::I32}, {0x60B2, DataType::I16},
        {0x60B8, DataType::U16}, {0x60B9, DataType::U16}, {0x60BA, DataType::I32}, {0x60BB, DataType::I32}, {0x60E0, DataType::U16},
        {0x60E1, DataType::U16}, {0x60FD, DataType::U32}, {0x60FF, DataType::I32}, {0x2021, DataType::U16}, {0x2005, DataType::U16},
        {0x6098, DataType::I8},  {0x6099, DataType::U32}, {0x609A, DataType::U32}, {0x2020, DataType::U16}, {0x6081, DataType::U32},
        {0x6084, DataType::U32}, {0x6087, DataType::U32}, {0x2000, DataType::U32}, {0x2001, DataType::U32}, {0x2051, DataType::U16},
        {0x2054, DataType::U16}, {0x6091, DataType::U32}};
    ecat::ObjectEntry e;
    e.index = index;
    e.sub = sub;
    e.name = "object";
    const auto base = index < 0x6000 ? index : static_cast<std::uint16_t>(0x6000 + (index - 0x6000) % 0x800);
    e.type = types.at(base);
    e.mappable = ecat::Mappable::both;
    if (base == 0x6072 || base == 0x60E0 || base == 0x60E1) e.value = e.maximum.emplace(5000);  // SV33-E 7.3
    if (base == 0x6098) e.minimum = -2, e.maximum = 35;                                         // SV33-E 7.3
    if (base == 0x6083) e.value = 100;
    if (base == 0x607F) e.value = 100'000'000;
    return e;
}

inline std::shared_ptr<ecat::DeviceDescription> device(std::string name, const Objects& rx, const Objects& tx) {
    auto d = std::make_shared<ecat::DeviceDescription>();
    d->name = std::move(name);
    d->identity = {1, 2, 3, 0};
    d->mailbox = ecat::MailboxDescription{};
    d->sync_managers = {{ecat::SmUse::mailbox_out, 0x1000, 0x80, 0x26},
                        {ecat::SmUse::mailbox_in, 0x1080, 0x80, 0x22},
                        {ecat::SmUse::outputs, 0x1100, 0, 0x64},
                        {ecat::SmUse::inputs, 0x1400, 0, 0x20}};
    d->rx_rules.max_entries = d->tx_rules.max_entries = 20;
    d->rx_pdos = {{0x1600, false, {}}};
    d->tx_pdos = {{0x1A00, false, {}}};
    d->dc = {true, false, true, 125us, Duration{}};
    const auto map = [&](const Objects& list, ecat::PdoDescription& pdo) {
        for (const auto& [index, sub] : list) {
            d->objects.push_back(object(index, sub));
            pdo.entries.push_back({index, sub, ecat::bit_size(d->objects.back().type)});
        }
    };
    map(rx, d->rx_pdos[0]);
    map(tx, d->tx_pdos[0]);
    d->rx_assigned = {0x1600};
    d->tx_assigned = {0x1A00};
    return d;
}

}  // namespace taktwerk::axes::cia402::test
