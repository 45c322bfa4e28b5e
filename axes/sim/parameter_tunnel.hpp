#pragma once
// An array that reaches any object of the dictionary: sub-index 1 takes the address (index << 8 | sub-index), sub-index 2 the value,
// sub-index 3 answers 0 when the value read is valid and 4 when it was written. Source: SV-DA200 4.9 (4300h). What else it answers is
// not stated; here it is 1, and the object stays as it is.

#include <cstdint>

#include "axes/port/drive_port.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class ParameterTunnel {
public:
    /// index 0: this drive has none.
    explicit ParameterTunnel(ParameterAddress object) noexcept : index_(object.index) {}

    void power_on(ecat::sim::ObjectDictionary& dictionary) noexcept { dictionary_ = &dictionary; }
    /// An SDO has written this object.
    void written(std::uint16_t index, std::uint8_t sub) noexcept;

private:
    [[nodiscard]] std::int64_t read(std::int64_t address, std::int64_t& value) const noexcept;
    [[nodiscard]] std::int64_t write(std::int64_t address, std::int64_t value) noexcept;

    std::uint16_t index_;
    ecat::sim::ObjectDictionary* dictionary_ = nullptr;
};

}  // namespace taktwerk::axes::sim
