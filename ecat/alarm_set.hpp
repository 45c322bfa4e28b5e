#pragma once
// Some of the bus' alarms in one word.

#include <cstddef>
#include <cstdint>

#include "ecat/alarms.hpp"

namespace taktwerk::ecat {

/// Some of them: a bit for each row of the table.
class BusAlarmSet {
public:
    constexpr BusAlarmSet() noexcept = default;
    explicit constexpr BusAlarmSet(std::uint64_t bits) noexcept : bits_(bits) {}
    template <BusAlarm alarm>
    [[nodiscard]] constexpr bool has() const noexcept {
        return (bits_ & bit<alarm>) != 0;
    }
    template <BusAlarm alarm>
    constexpr void set() noexcept {
        bits_ |= bit<alarm>;
    }

    template <BusAlarm alarm>
    static constexpr std::uint64_t bit = [] {
        std::size_t row = 0;  // by index: sanitizers of g++ 12 take no comparison of a pointer for constant
        while (row < bus_alarms.size() && bus_alarms[row].id != id(alarm)) ++row;
        static_assert(bus_alarms.size() <= 64);
        return std::uint64_t{1} << (row < bus_alarms.size() ? row : throw "not in the table");
    }();

private:
    std::uint64_t bits_ = 0;
};

}  // namespace taktwerk::ecat
