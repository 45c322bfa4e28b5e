#pragma once
// Small handles to what is too large for a pin: tables, triggers, groups of digital points. Trivially copyable; invalid by default.
// They are resolved through MotionTables and the axes; no pointer is kept in a block.

#include <cstdint>

#include "axes/words/types.hpp"

namespace taktwerk::axes {

/// A cam as a program wrote it (MC_CAM_REF): points that may still be edited.
struct CamRef {
    std::uint16_t index = 0xFFFF;
    friend constexpr bool operator==(CamRef, CamRef) = default;
};
/// A cam prepared by MC_CamTableSelect (MC_CAM_ID): checked, with its coefficients. 0 = none.
struct CamId {
    std::uint32_t value = 0;
    friend constexpr bool operator==(CamId, CamId) = default;
};
/// A table over time (MC_TP_REF, MC_TV_REF, MC_TA_REF).
struct TimeTableRef {
    std::uint16_t index = 0xFFFF;
    friend constexpr bool operator==(TimeTableRef, TimeTableRef) = default;
};
/// A list of cam switches (MC_CAMSWITCH_REF), options of its tracks (MC_TRACK_REF).
struct CamSwitchRef {
    std::uint16_t index = 0xFFFF;
    friend constexpr bool operator==(CamSwitchRef, CamSwitchRef) = default;
};
struct TrackRef {
    std::uint16_t index = 0xFFFF;
    friend constexpr bool operator==(TrackRef, TrackRef) = default;
};

/// Digital points that a block reads (MC_INPUT_REF): an input point of the machine, or the inputs of an axis' drive (60FDh).
struct InputRef {
    std::uint16_t point = 0xFFFF;  ///< index of a declared input; wins over `axis`
    AxisRef axis{};
    friend constexpr bool operator==(InputRef, InputRef) = default;
};
/// Digital points that a block writes (MC_OUTPUT_REF): an output point of the machine, or the outputs of an axis' drive (60FEh).
struct OutputRef {
    std::uint16_t point = 0xFFFF;
    AxisRef axis{};
    friend constexpr bool operator==(OutputRef, OutputRef) = default;
};

/// What triggers a probe (MC_TRIGGER_REF): one of the drive's probes with hardware latch, its index pulse, a switch of the drive, or
/// an input of the machine (latched in software and interpolated between two cycles).
enum class TriggerSource : std::uint8_t { probe1, probe2, index_pulse, home_switch, input };
struct TriggerRef {
    TriggerSource source = TriggerSource::probe1;
    bool falling = false;          ///< which edge
    std::uint16_t point = 0xFFFF;  ///< TriggerSource::input: index of a declared input
    std::uint8_t bit = 0;          ///< of that input
    friend constexpr bool operator==(TriggerRef, TriggerRef) = default;
};

}  // namespace taktwerk::axes
