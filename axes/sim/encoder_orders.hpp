#pragma once
// How a drive is told that its encoder is to forget its turns or its fault: by an object, or by a bit of the control word. Sources: SV33-E
// P20.05; TSVM 5.3.2, 7.2.1 (PA80).

#include <cstdint>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class EncoderOrders {
public:
    explicit EncoderOrders(const DriveEncoder& encoder) noexcept
        : turns_(encoder.clear_turns),
          reset_(encoder.reset),
          turns_value_(encoder.clear_turns_value),
          turns_control_(encoder.clear_turns_control) {}

    /// `offset` of this axis from the first.
    void power_on(ecat::sim::ObjectDictionary& dictionary, unsigned offset);
    /// Each exchange, with its control word.
    void serve(Cia402Axis& axis, std::uint16_t control);

private:
    ParameterAddress turns_, reset_;
    std::int64_t turns_value_;
    std::uint16_t turns_control_;
    ecat::sim::Entry *turns_entry_ = nullptr, *reset_entry_ = nullptr;
    bool asked_ = false;  ///< the control word's bit stood in the exchange before
};

}  // namespace taktwerk::axes::sim
