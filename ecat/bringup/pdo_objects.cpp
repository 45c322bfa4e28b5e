#include "ecat/bringup/pdo_objects.hpp"

#include <fmt/format.h>

#include "ecat/bringup/slave_objects.hpp"

namespace taktwerk::ecat {

Script<Result<void>> write_mapping(Bus& bus, BusSlave& slave, const PdoDescription& pdo) {
    Result<void> written = co_await write_number(bus, slave, pdo.index, 0, 0, 1);
    if (!written) co_return written;
    std::uint8_t sub = 0;
    for (const auto& entry : pdo.entries) {
        written = co_await write_number(bus, slave, pdo.index, ++sub, mapped_as(entry), 4);
        if (!written) co_return written;
    }
    co_return co_await write_number(bus, slave, pdo.index, 0, static_cast<std::uint32_t>(pdo.entries.size()), 1);
}

Script<Result<void>> write_assigned(Bus& bus, BusSlave& slave, std::uint16_t assignment, const std::vector<PdoDescription>& pdos) {
    std::uint8_t sub = 0;
    for (const auto& pdo : pdos) {
        const Result<void> written = co_await write_number(bus, slave, assignment, ++sub, pdo.index, 2);
        if (!written) co_return written;
    }
    co_return co_await write_number(bus, slave, assignment, 0, static_cast<std::uint32_t>(pdos.size()), 1);
}

Script<Result<PdoDescription>> read_mapping(Bus& bus, BusSlave& slave, std::uint16_t index) {
    PdoDescription pdo;
    pdo.index = index;
    const Result<std::uint32_t> entries = co_await read_number(bus, slave, index, 0);
    if (!entries) co_return entries.error();
    for (std::uint32_t k = 1; k <= (*entries & 0xFFu); ++k) {
        const Result<std::uint32_t> entry = co_await read_number(bus, slave, index, static_cast<std::uint8_t>(k));
        if (!entry) co_return entry.error();
        pdo.entries.push_back(
            {static_cast<std::uint16_t>(*entry >> 16), static_cast<std::uint8_t>(*entry >> 8), static_cast<std::uint8_t>(*entry)});
    }
    co_return pdo;
}

Script<Result<std::vector<std::uint16_t>>> read_assignment(Bus& bus, BusSlave& slave, std::uint16_t assignment) {
    bus.note(slave, fmt::format("reading the PDOs of {:04X}h", assignment));
    std::vector<std::uint16_t> numbers;
    const Result<std::uint32_t> count = co_await read_number(bus, slave, assignment, 0);
    if (!count) co_return count.error();
    for (std::uint32_t i = 1; i <= (*count & 0xFFu); ++i) {
        const Result<std::uint32_t> index = co_await read_number(bus, slave, assignment, static_cast<std::uint8_t>(i));
        if (!index) co_return index.error();
        const auto number = static_cast<std::uint16_t>(*index);
        if (number != 0) numbers.push_back(number);  // 0: an empty place of a fixed list
    }
    co_return numbers;
}

}  // namespace taktwerk::ecat
