#pragma once
// MC_DigitalCamSwitch: PLCopen Part 1 v2.0, 3.32. How a track switches: cam_tracks.hpp. Real-time safe.

#include <cstdint>
#include <string_view>

#include "axes/axis/parameters.hpp"
#include "fb_library/motion/cam_tracks.hpp"
#include "fb_library/motion/enable_core.hpp"

namespace taktwerk::fb {

/// Tracks of several switches are on while any of them is. Outputs: a point of the machine, track n on its bit n - 1, or an axis for its
/// drive's outputs, track n (up to 16) on bit 15 + n of 60FEh, where the free outputs begin; only bits of tracks that a switch names
/// are written, and a track whose bit the point does not have is invalid_output. They go off with Enable and with an error. Without Outputs the tracks can be read from `on`.
/// Error with invalid_table: no such list, or something in it that cannot be (see CamTracks::usable); the list may be edited while it works.
struct MC_DigitalCamSwitch {
    using Self = MC_DigitalCamSwitch;
    AxisRef Axis{};
    CamSwitchRef Switches{};
    OutputRef Outputs{};
    TrackRef TrackOptions{};
    bool Enable = false;
    DWORD EnableMask = 0xFFFF'FFFF;
    MC_Source ValueSource = mcSetValue;

    bool InOperation = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    std::uint32_t on = 0;  ///< not a pin: bit n - 1 = track n

    static constexpr std::string_view summary = "Switches outputs by the axis' position, like cams on its shaft.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis>(), in_out<&Self::Switches>("", "list of cam switches"),
                         in_out<&Self::Outputs>("", "a point of the machine, or an axis for its drive's outputs"),
                         in_out<&Self::TrackOptions>("", "compensation and hysteresis by track, as they stand in each scan; none: zero"),
                         shared<&Self::Enable>(), in<&Self::EnableMask>("", "bit n - 1 enables track n; at first all of them"),
                         in<&Self::ValueSource>("", "whose position and velocity: the set-point's or the actual ones"),
                         out<&Self::InOperation>("", "the tracks are switched"), shared<&Self::Busy>(),
                         out<&Self::Error>("", "cannot switch; the tracks are off"), shared<&Self::ErrorID>());
    }

    /// Real-time safe. Call it in every scan.
    void operator()(const MotionContext& ctx) noexcept {
        core_.begin(Enable);
        if (core_.working()) core_.took(run(ctx));
        if (!core_.valid()) rest(ctx);
        core_.publish(*this);
    }
    void warm_start(Instant) noexcept { tracks_.reset(); }

private:
    static constexpr std::uint16_t no_point = 0xFFFF;
    static constexpr std::uint32_t drive_tracks = 0xFFFF, first_drive_bit = 16;

    [[nodiscard]] Reading run(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(Axis);
        if (view == nullptr) return Reading::unless(ErrorId::invalid_axis);
        if (!view->online) return Reading::unless(ErrorId::drive_not_ready);
        if (ctx.tables == nullptr) return Reading::unless(ErrorId::invalid_table);
        const auto switches = ctx.tables->cam_switches(Switches);
        const auto options = ctx.tables->track_options(TrackOptions);
        if (switches.empty() || !CamTracks::usable(switches, options, view->modulo)) return Reading::unless(ErrorId::invalid_table);

        std::uint32_t named = 0;
        for (const auto& s : switches) named |= 1u << (s.track - 1u);
        const bool actual = ValueSource == mcActualValue;
        const CamTracks::Sample sample{.position = actual ? view->actual_position : view->set_position,
                                       .velocity = actual ? view->actual_velocity : view->set_velocity,
                                       .modulo = view->modulo,
                                       .longest_step = 2 * view->parameters[axes::velocity_of_system] * to_seconds(ctx.period),
                                       .now = ctx.now,
                                       .period = ctx.period};
        on = tracks_.step(sample, switches, options, EnableMask);
        return Reading::unless(write(ctx, on, named));
    }

    void rest(const MotionContext& ctx) noexcept {
        on = 0;
        tracks_.reset();
        if (written_ != 0) (void)write(ctx, 0, 0);
    }

    /// Tracks that were written before and that no switch names any more go off.
    [[nodiscard]] ErrorId write(const MotionContext& ctx, std::uint32_t tracks, std::uint32_t named) noexcept {
        const auto touched = named | written_;
        if (Outputs.point != no_point) {
            if (Outputs.point >= ctx.outputs.size() || (named & ~ctx.output_mask(Outputs.point)) != 0) return ErrorId::invalid_output;
            auto& word = ctx.outputs[Outputs.point];
            word = static_cast<std::int64_t>((static_cast<std::uint64_t>(word) & ~std::uint64_t{touched}) | tracks);
        } else if (Outputs.axis.valid()) {
            if (const auto error = write_drive(ctx, tracks, touched); error != ErrorId::none) return error;
        }
        written_ = named;
        levels_ = tracks;
        return ErrorId::none;
    }

    /// Each bit once, when it changes.
    [[nodiscard]] ErrorId write_drive(const MotionContext& ctx, std::uint32_t tracks, std::uint32_t touched) noexcept {
        if (ctx.view(Outputs.axis) == nullptr || (touched & ~drive_tracks) != 0) return ErrorId::invalid_output;
        const auto fresh = touched & ~written_;
        for (std::uint32_t bit = 0; bit < 16; ++bit) {
            const auto mask = 1u << bit;
            if (((fresh | (levels_ ^ tracks)) & touched & mask) == 0) continue;
            const axes::WriteOutput output{static_cast<std::int32_t>(first_drive_bit + bit), (tracks & mask) != 0};
            if (const auto error = ctx.requests->set(Outputs.axis, output, ctx.owner).error; error != ErrorId::none) return error;
        }
        return ErrorId::none;
    }

    EnableCore core_;
    CamTracks tracks_;
    std::uint32_t written_ = 0, levels_ = 0;  // tracks that are this block's; and how they were written
};

}  // namespace taktwerk::fb
