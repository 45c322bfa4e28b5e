#pragma once
// A setting of the ports' loops that ends by itself (0100h bit 1): the one before returns. Source: ETG.1000.4, DL control.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::ecat::sim {

class TemporaryLoops {
public:
    /// `before`: the modes that return, unless older ones wait to.
    void begin(std::uint8_t before, Instant until) noexcept {
        if (until_ == Instant::max()) kept_ = before;
        until_ = until;
    }
    void end() noexcept { until_ = Instant::max(); }
    [[nodiscard]] Instant until() const noexcept { return until_; }
    [[nodiscard]] std::uint8_t kept() const noexcept { return kept_; }

private:
    Instant until_ = Instant::max();  // none is set
    std::uint8_t kept_ = 0;
};

}  // namespace taktwerk::ecat::sim
