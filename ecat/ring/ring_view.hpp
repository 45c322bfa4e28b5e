#pragma once
// A ring as the cycle asks it, whoever plays it: two interfaces (ring_transport.hpp), or a recording of what they said.

#include <cstddef>

#include "ecat/ring/ring_state.hpp"

namespace taktwerk::ecat {

/// All of the cycle's thread, real-time safe.
class RingView {
public:
    virtual ~RingView() = default;
    /// As of the frames given back last.
    [[nodiscard]] virtual const RingState& state() const noexcept = 0;
    /// Of one of its two ends, 0 or 1.
    [[nodiscard]] virtual bool link_up(std::size_t end) const noexcept = 0;
    /// What the half without the reference clock gets in the place of its time.
    virtual void set_clocks(const RingClocks& clocks) noexcept = 0;
};

}  // namespace taktwerk::ecat
