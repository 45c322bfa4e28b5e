#pragma once
// Does a motor run where it is sent? An encoder that is wired the other way round turns the position loop into a runaway. Looked at from each
// enabling on, until the motor has run as far with its set-point as it may run against it; from there on the following error is watched anyway.
// Pure logic; real-time safe.

#include <algorithm>

namespace taktwerk::axes::analog {

class PolarityWatch {
public:
    /// counts, > 0.
    explicit PolarityWatch(double distance) noexcept : distance_(distance) {}

    void begin() noexcept {
        with_ = against_ = 0;
        proven_ = false;
    }
    /// Counts that the motor moved while it was sent with `driven` (any unit; 0: it was not). True: too far the wrong way.
    [[nodiscard]] bool step(double moved, double driven) noexcept {
        if (proven_ || driven == 0 || moved == 0) return false;
        const double way = driven > 0 ? moved : -moved;
        // What goes forth and back, as at standstill, proves nothing.
        with_ = std::max(0.0, with_ + way);
        against_ = std::max(0.0, against_ - way);
        proven_ = with_ >= distance_;
        return against_ > distance_;
    }
    /// Counts that it is on the wrong way.
    [[nodiscard]] double against() const noexcept { return against_; }

private:
    double distance_;
    double with_ = 0, against_ = 0;
    bool proven_ = false;
};

}  // namespace taktwerk::axes::analog
