#pragma once
// Where a counter or encoder terminal shows its position, and what belongs to it. Plain data, filled from a device file by config/.

#include <cstdint>
#include <string>
#include <vector>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

/// A way to latch the position: while `arm` is 1 the terminal waits for the event; `latched` is 1 from then on until `arm` is taken back.
struct EncoderLatch {
    ParameterAddress arm{}, latched{};
    [[nodiscard]] bool there() const noexcept { return arm.index != 0; }
};

struct EncoderChannel {
    std::string name{};  ///< of its position, for messages
    ParameterAddress position{};
    std::vector<ParameterAddress> errors{};  ///< not 0 while the position does not hold
    ParameterAddress valid{};                ///< 0 while the position does not hold; index 0: there is none
    ParameterAddress latch{};                ///< the position at the event
    EncoderLatch index{}, rising{}, falling{};
    bool incremental = false;  ///< it begins to count at 0 when its terminal gets its supply
    std::uint8_t bits = 0;     ///< in which it counts before it begins anew, where these are fewer than its object has; 0: all
};

}  // namespace taktwerk::axes
