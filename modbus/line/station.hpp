#pragma once
// Somebody who listens on a line and may answer: the simulated drive. Knows nothing of who carries the bytes.

#include <cstddef>
#include <span>

#include "core/time.hpp"
#include "modbus/line/line_settings.hpp"
#include "modbus/wire/frame.hpp"

namespace taktwerk::modbus {

class Station {
public:
    virtual ~Station() = default;

    /// Lives on until `now`.
    virtual void advance(Instant now) = 0;
    /// A frame that silence has ended, at `now`; whatever its bytes. What is to be answered goes into `answer`; false: silence.
    virtual bool hear(std::span<const std::byte> frame, Instant now, Frame& answer) = 0;
    /// From the end of a request to the first byte of the answer.
    [[nodiscard]] virtual Duration turnaround() const noexcept = 0;
    /// A station that is set otherwise hears nothing but noise.
    [[nodiscard]] virtual LineSettings line() const noexcept = 0;
};

}  // namespace taktwerk::modbus
