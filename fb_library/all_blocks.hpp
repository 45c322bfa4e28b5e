#pragma once
// Every block there is: the one list that monitor, documentation, typed tests and compiler iterate. A new block is added here.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "fb_library/block_type.hpp"
#include "fb_library/fieldbus/sdo.hpp"
#include "fb_library/iec/bistables.hpp"
#include "fb_library/iec/counters.hpp"
#include "fb_library/iec/edges.hpp"
#include "fb_library/iec/timers.hpp"
#include "fb_library/motion/administration.hpp"
#include "fb_library/motion/axis_condition.hpp"
#include "fb_library/motion/axis_values.hpp"
#include "fb_library/motion/digital_cam_switch.hpp"
#include "fb_library/motion/digital_io.hpp"
#include "fb_library/motion/endless_moves.hpp"
#include "fb_library/motion/home.hpp"
#include "fb_library/motion/jog.hpp"
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/parameter_blocks.hpp"
#include "fb_library/motion/power.hpp"
#include "fb_library/motion/probes.hpp"
#include "fb_library/motion/reading.hpp"
#include "fb_library/motion/stops.hpp"

namespace taktwerk::fb {

template <class... Blocks>
struct BlockList {
    static constexpr std::array types{block_type<Blocks>()...};

    /// E.g. `IecBlocks::as<testing::Types>` for a typed test.
    template <template <class...> class Other>
    using as = Other<Blocks...>;
};

using IecBlocks = BlockList<SR, RS, R_TRIG, F_TRIG, CTU, CTU_DINT, CTU_LINT, CTU_UDINT, CTU_ULINT, CTD, CTD_DINT, CTD_LINT, CTD_UDINT,
                            CTD_ULINT, CTUD, CTUD_DINT, CTUD_LINT, CTUD_UDINT, CTUD_ULINT, TP, TON, TOF>;

using MotionBlocks = BlockList<MC_Power, MC_Home, MC_Stop, MC_Halt, MC_MoveAbsolute, MC_MoveRelative, MC_MoveAdditive, MC_MoveVelocity,
                               MC_MoveContinuousAbsolute, MC_MoveContinuousRelative, MC_Jog, MC_SetPosition, MC_ReadActualPosition,
                               MC_ReadStatus, MC_ReadAxisError, MC_Reset, MC_ReadParameter, MC_ReadBoolParameter, MC_WriteParameter,
                               MC_WriteBoolParameter, MC_ReadDigitalInput, MC_ReadDigitalOutput, MC_WriteDigitalOutput,
                               MC_ReadActualVelocity, MC_ReadActualTorque, MC_ReadMotionState, MC_ReadAxisInfo, MC_ReadCommandPosition,
                               MC_ReadCommandVelocity, MC_ReadCommandAcceleration, MC_DigitalCamSwitch, MC_TouchProbe, MC_AbortTrigger>;

using FieldbusBlocks = BlockList<EC_SdoRead, EC_SdoWrite>;

namespace detail {
template <class... A, class... B>
BlockList<A..., B...> joined(BlockList<A...>, BlockList<B...>);

template <class... Blocks>
consteval bool names_differ(BlockList<Blocks...>) {
    constexpr auto& types = BlockList<Blocks...>::types;
    for (std::size_t i = 0; i < types.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (types[i].name == types[j].name) return false;
    return true;
}
}  // namespace detail

using AllBlocks = decltype(detail::joined(detail::joined(IecBlocks{}, MotionBlocks{}), FieldbusBlocks{}));
static_assert(detail::names_differ(AllBlocks{}));

[[nodiscard]] constexpr std::span<const BlockType> all_block_types() noexcept { return AllBlocks::types; }

/// nullptr when there is none of that name. Not for the cycle.
[[nodiscard]] constexpr const BlockType* find_block_type(std::string_view name) noexcept {
    for (const BlockType& type : all_block_types())
        if (type.name == name) return &type;
    return nullptr;
}

/// The library's part of the ABI hash: differs when a block or pin is added, removed, moved, renamed or retyped.
inline constexpr std::uint64_t block_abi_hash = [] {
    std::uint64_t hash = 0xCBF29CE484222325;
    for (const BlockType& type : all_block_types()) hash = layout_hash(hash, type);
    return hash;
}();

}  // namespace taktwerk::fb
