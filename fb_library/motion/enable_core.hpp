#pragma once
// The lifecycle of Enable blocks, once for all: PLCopen Part 1 v2.0, 2.2.3 (figures 5 and 6), 2.4.1. Real-time safe.
//
//   * Works while Enable is TRUE; inputs are read in each call. When Enable falls every output goes back, in that call.
//   * Valid and Error exclude each other. An error that goes away by itself leaves Busy TRUE, and Valid returns with the values.
//   * A final error ends the work (Busy FALSE) until the next rising edge of Enable.

#include <cstdint>

#include "fb_library/motion/motion_types.hpp"
#include "fb_library/motion/shared_pins.hpp"

namespace taktwerk::fb {

/// One call's result.
struct Reading {
    enum class Kind : std::uint8_t { waiting, valid, passing_error, final_error };
    Kind kind = Kind::waiting;
    ErrorId error = ErrorId::none;

    [[nodiscard]] static constexpr Reading valid() noexcept { return {Kind::valid, ErrorId::none}; }
    /// An error that may go away while Enable stays TRUE; none = valid.
    [[nodiscard]] static constexpr Reading unless(ErrorId error) noexcept {
        return {error == ErrorId::none ? Kind::valid : Kind::passing_error, error};
    }
    [[nodiscard]] static constexpr Reading final_error(ErrorId error) noexcept { return {Kind::final_error, error}; }
};

class EnableCore {
public:
    enum class Edge : std::uint8_t { none, rising, falling };

    /// First thing in each call.
    constexpr Edge begin(bool enable) noexcept {
        const Edge edge = enable == enable_ ? Edge::none : enable ? Edge::rising : Edge::falling;
        enable_ = enable;
        if (edge != Edge::none) last_ = {};
        return edge;
    }
    /// Whether this call has something to read.
    [[nodiscard]] constexpr bool working() const noexcept { return enable_ && last_.kind != Reading::Kind::final_error; }
    /// True: it is another one than before.
    constexpr bool took(Reading reading) noexcept {
        const bool other = reading.kind != last_.kind || reading.error != last_.error;
        last_ = reading;
        return other;
    }
    [[nodiscard]] constexpr bool valid() const noexcept { return enable_ && last_.kind == Reading::Kind::valid; }

    /// Sets whichever of the standard's outputs the block has.
    template <class Block>
    constexpr void publish(Block& block) const noexcept {
        if constexpr (requires { block.Valid; }) block.Valid = valid();
        if constexpr (requires { block.Enabled; }) block.Enabled = valid();
        if constexpr (requires { block.InOperation; }) block.InOperation = valid();
        if constexpr (requires { block.Busy; }) block.Busy = working();
        block.Error = last_.error != ErrorId::none;
        block.ErrorID = last_.error;
    }

private:
    Reading last_{};
    bool enable_ = false;
};

/// Base of the reading blocks. The block says `Reading read(const AxisView&)`, which fills its outputs (or, public, `read(const
/// MotionContext&)` when it needs more than its axis), and `clear()`, which puts them back; clear() runs whenever Valid is FALSE, so that nobody takes an old value for a new one.
template <class Block>
struct EnableBlock {
    using Self = Block;

    /// Real-time safe.
    void operator()(const MotionContext& ctx) noexcept {
        Block& block = static_cast<Block&>(*this);
        bool news = core_.begin(block.Enable) != EnableCore::Edge::none;
        if (core_.working()) {
            if constexpr (requires { block.read(ctx); }) news |= core_.took(block.read(ctx));
            else news |= core_.took(read_axis(block, ctx));
        }
        if (!core_.valid()) block.clear();
        if (news) core_.publish(block);
    }

    void warm_start(Instant) noexcept {}

protected:
    [[nodiscard]] static Reading read_axis(Block& block, const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(block.Axis);
        return view != nullptr ? block.read(*view) : Reading::unless(ErrorId::invalid_axis);
    }

    EnableCore core_;
};

}  // namespace taktwerk::fb
